#pragma once

#include <apsis/steady/continuation.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Continuation in the rarefaction: solves T(f) + Q(f)/(s ε) = 0 for decreasing factors s = 4^m, …, 16, 4.
/// Sweeps alone settle the first of these gases, and the last one is a start for s = 1.
class rarer_gases final : public continuation {
 public:
  /// Returns the factors for a domain that is so many mean free paths long (steady_solver::optical_length());
  /// none where it is short.
  static std::vector<double> factors(double optical_length);

  /// `factors`: at least one, decreasing. All references must outlive the object.
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
