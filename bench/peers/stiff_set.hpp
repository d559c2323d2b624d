#pragma once

#include <apsis/exec/thread_clock.hpp>
#include <apsis/integrate/autodiff.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>
#include <apsis/verify/stiff_problem.hpp>

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace apsis::bench::peers {

/// An integration of a problem of apsis/verify/stiff_problem.hpp.
struct stiff_outcome {
  std::vector<double> u;     ///< solution at the end
  long steps = 0;            ///< accepted steps
  long rates = 0;            ///< calls of Q for its value
  double jacobians = 0;      ///< evaluations of Q'; products of Apsis count as parts of one
  std::string failure = {};  ///< empty if the end was reached
};

/// Tolerances and time limit of an integration: atol_i = rtol · size_i.
struct stiff_limits {
  double rtol = 1e-6;
  double seconds = std::numeric_limits<double>::infinity();  ///< most CPU time of the thread
};

/// Q and Q' of a stiff problem, with the functions and the automatic derivatives of Apsis. It counts
/// their calls.
class stiff_system {
 public:
  explicit stiff_system(const stiff_problem_entry& problem);

  /// Chooses Q between times[piece] and times[piece + 1].
  void begin(std::size_t piece) { rate_ = problem_.rate(piece); }
  std::size_t size() const { return pattern_.size(); }
  bool is_banded() const { return problem_.pattern != nullptr; }  ///< every pattern of this set is a band
  const sparsity_pattern& pattern() const { return pattern_; }    ///< full without a pattern of the problem
  std::size_t width() const;                                      ///< largest |row − column| of the pattern

  /// out ← Q(t, u).
  void rate(double t, const double* u, double* out);
  /// Calls set(row, column, entry of Q'(t, u)) for every place of the pattern, with one call of Q for each
  /// group of columns.
  template <class Set>
  void jacobian(double t, const double* u, const Set& set) {
    ++jacobians_;
    const dual<double> s(0.0, true), now(t);
    for (const auto& group : pattern_.groups()) {
      for (std::size_t j = 0; j < size(); ++j) in_[j] = u[j];
      for (const std::size_t j : group) in_[j] = s + u[j];
      rate_->evaluate(now, in_, out_);
      for (const std::size_t j : group)
        for (const std::size_t i : pattern_.rows(j)) set(i, j, out_[i].derivative(1));
    }
  }

  long rates() const { return rates_; }
  long jacobians() const { return jacobians_; }
  const stiff_problem_entry& problem() const { return problem_; }

 private:
  const stiff_problem_entry& problem_;
  sparsity_pattern pattern_;
  std::unique_ptr<stiff_rate> rate_;
  std::vector<dual<double>> in_, out_;
  long rates_ = 0, jacobians_ = 0;
};

/// A clock that states whether a run has taken too long.
class stiff_clock {
 public:
  explicit stiff_clock(double most) : most_(most), begin_(thread_seconds()) {}
  bool is_over() const { return thread_seconds() - begin_ > most_; }

 private:
  double most_, begin_;
};

/// The value of stiff_outcome::failure for a run that exceeds stiff_limits::seconds.
inline constexpr const char* too_slow = "too slow";

/// Runs a method of Apsis.
stiff_outcome run_apsis_stiff(const stiff_problem_entry& problem, const std::string& method,
                              const stiff_limits& limits);
/// Runs CVODE with BDF, exact Jacobians and a dense or a band solver.
stiff_outcome run_cvode_stiff(const stiff_problem_entry& problem, const stiff_limits& limits);
/// Runs ARKODE with its default diagonally implicit method of an order, with exact Jacobians and a dense or a
/// band solver.
stiff_outcome run_arkode_stiff(const stiff_problem_entry& problem, int order, const stiff_limits& limits);
/// Runs Radau IIA of order 5 (radau_steps.hpp) with exact Jacobians and dense or sparse factorizations.
stiff_outcome run_radau_stiff(const stiff_problem_entry& problem, const stiff_limits& limits);

}  // namespace apsis::bench::peers
