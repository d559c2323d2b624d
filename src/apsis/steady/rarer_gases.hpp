#pragma once

#include <apsis/steady/continuation.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Continuation in the rarefaction: solves T(f) + Q(f)/(s ε) = 0 for decreasing factors s = 4^m, …, 16, 4.
/// Sweeps alone converge for the first of these gases, and the last solution is a start for s = 1.
class rarer_gases final : public continuation {
 public:
  /// Returns the factors for a domain with a length of this many mean free paths
  /// (steady_solver::optical_length()). There are no factors for a short domain.
  static std::vector<double> factors(double optical_length);

  /// `factors` are decreasing, and there is at least one. All references must outlive the object.
  rarer_gases(const relaxation_model& equation, const problem_builder& space, std::vector<double> factors,
              int images);

  std::string name() const override;

 private:
  problem_builder problem(std::size_t number) const override;
  std::string name_of(std::size_t number) const override;

  problem_builder space_;
  std::vector<double> factors_;
};

}  // namespace apsis
