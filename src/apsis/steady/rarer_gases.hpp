#pragma once

#include <apsis/steady/steady_solver.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// Continuation in the rarefaction: solves T(f) + Q(f)/(s ε) = 0 for decreasing factors s = 4^m, …, 16, 4,
/// each from the solution of the last one. Sweeps alone settle the first of these gases, and the last one is
/// a start for s = 1. The sums of conserved moments stay those of the first state.
///
/// On several processes every member is collective.
class rarer_gases {
 public:
  /// Returns the factors for a domain that is so many mean free paths long (steady_solver::optical_length());
  /// none where it is short.
  static std::vector<double> factors(double optical_length);

  /// `factors`: at least one, decreasing. All references must outlive the object.
  rarer_gases(const relaxation_model& equation, const problem_builder& space, std::vector<double> factors,
              int images);
  ~rarer_gases();
  rarer_gases(const rarer_gases&) = delete;
  rarer_gases& operator=(const rarer_gases&) = delete;

  /// Takes one iteration. Throws numerical_error where the present gas does not settle.
  steady_iteration iterate(field& f);
  /// Whether f belongs to the last factor.
  bool finished() const { return next_ == factors_.size(); }
  /// Returns steady_iteration::damping of the last iteration; every gas begins with that of the one before
  /// it.
  int damping() const { return damping_; }

 private:
  struct gas;

  const relaxation_model& equation_;
  problem_builder space_;
  std::vector<double> factors_;
  int images_;
  int damping_ = 0;
  std::size_t next_ = 0;      ///< factor
  std::unique_ptr<gas> now_;  ///< the gas of that factor, once begun
};

}  // namespace apsis
