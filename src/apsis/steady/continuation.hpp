#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/steady/damping.hpp>
#include <apsis/steady/steady_solver.hpp>

#include <cstddef>
#include <memory>
#include <string>

namespace apsis {

/// Continuation: loose steady states of easier problems, each from the solution of the last one. The last one
/// is a start for the problem itself. The sums of conserved moments stay those of the first state.
///
/// On several processes every member is collective.
class continuation {
 public:
  virtual ~continuation();
  continuation(const continuation&) = delete;
  continuation& operator=(const continuation&) = delete;

  /// Takes one iteration. Throws numerical_error where the present problem does not settle.
  steady_iteration iterate(field& f);
  /// Whether f belongs to the last problem.
  bool finished() const { return next_ == size_; }
  /// Returns steady_iteration::damping of the last iteration; every problem begins with that of the one
  /// before it.
  int damping() const { return damping_; }
  /// Returns the steady states in words: "steady states with 16, 4 times the epsilon".
  virtual std::string name() const = 0;

 protected:
  /// `size`: number of problems; `images`: of the mixture. The model must outlive the object.
  continuation(const relaxation_model& equation, std::size_t size, int images);

 private:
  struct attempt;

  /// Returns the builder of a problem.
  virtual problem_builder problem(std::size_t number) const = 0;
  /// Returns it in words: "4 times the epsilon".
  virtual std::string name_of(std::size_t number) const = 0;

  const relaxation_model& equation_;
  std::size_t size_, next_ = 0;
  int images_, damping_ = 0;
  std::unique_ptr<attempt> now_;  ///< the next problem, once begun
};

/// Returns the continuation of a number, from 0 on: rarer_gases, then milder_ends. Returns nullptr where the
/// gas is rare, or no end has an effect. `optical_length`: steady_solver::optical_length(). All references
/// but `start` must outlive the result. Collective.
std::unique_ptr<continuation> make_continuation(std::size_t number, const relaxation_model& equation,
                                                const problem_builder& space, const field& start,
                                                double optical_length, int images);
/// Their number.
inline constexpr std::size_t continuations = 2;
/// The number of those that may help after a stall.
inline std::size_t continuations_after(const steady_stall& stall) {
  return stall.is_near() ? 1 : continuations;
}

}  // namespace apsis
