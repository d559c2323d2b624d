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

/// Continuation: computes steady states of easier problems to a loose tolerance, each one from the solution
/// before. The last solution is a start for the problem itself. The sums of conserved moments stay those of
/// the first state.
///
/// On several processes every member is collective.
class continuation {
 public:
  virtual ~continuation();
  continuation(const continuation&) = delete;
  continuation& operator=(const continuation&) = delete;

  /// Performs one iteration. Throws numerical_error if the iteration for the present problem
  /// does not converge.
  steady_iteration iterate(field& f);
  /// Returns true if f is the solution of the last problem.
  bool finished() const { return next_ == size_; }
  /// Returns steady_iteration::damping of the last iteration. Every problem begins with the damping of
  /// the problem before.
  int damping() const { return damping_; }
  /// Returns a description: "steady states with 16, 4 times the epsilon".
  virtual std::string name() const = 0;

 protected:
  /// `size` is the number of problems, and `images` is the number of images in the mixture. The model must
  /// outlive the object.
  continuation(const relaxation_model& equation, std::size_t size, int images);

 private:
  struct attempt;

  /// Returns the builder of a problem.
  virtual problem_builder problem(std::size_t number) const = 0;
  /// Returns a description of a problem: "4 times the epsilon".
  virtual std::string name_of(std::size_t number) const = 0;

  const relaxation_model& equation_;
  std::size_t size_, next_ = 0;
  int images_, damping_ = 0;
  std::unique_ptr<attempt> now_;  ///< the next problem, once begun
};

/// Returns the continuation with a number: 0 is rarer_gases, and 1 is milder_ends. Returns nullptr if the gas
/// is rare (0) or no end has an effect (1). `optical_length` is steady_solver::optical_length(). All
/// references except `start` must outlive the result. Collective.
std::unique_ptr<continuation> make_continuation(std::size_t number, const relaxation_model& equation,
                                                const problem_builder& space, const field& start,
                                                double optical_length, int images);
/// The number of continuations.
inline constexpr std::size_t continuations = 2;
/// Returns the number of continuations that may help after a stall.
inline std::size_t continuations_after(const steady_stall& stall) {
  return stall.is_near() ? 1 : continuations;
}

}  // namespace apsis
