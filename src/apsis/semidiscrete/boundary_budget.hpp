#pragma once

#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// Amounts of the invariants that a state has received through its surfaces, from a force, from the rotation
/// of axisymmetric flow, and from a source. The layout is:
/// - [surface][end][invariant] over all ends at surfaces, in the order of domain::budget_surfaces(),
/// - the totals of a force, of the rotation and of a source,
/// - the force_losses.
///
/// The budget is empty if nothing was received; this is equivalent to zeros.
class boundary_budget {
 public:
  boundary_budget() = default;
  /// Takes amounts in the layout of the class.
  explicit boundary_budget(std::vector<double> amounts) : amounts_(std::move(amounts)) {}

  const std::vector<double>& amounts() const { return amounts_; }  ///< in the layout of the class

  /// Resets the budget to zero and keeps its memory.
  void clear() { amounts_.clear(); }
  /// this ← factor · this.
  void scale(double factor);
  /// this ← this + factor · amounts; enlarges the budget if there are more amounts.
  void add(double factor, std::span<const double> amounts);

  /// this ← (fresh ? 0 : this) + α of + β rates, as for a target of add_transport(). `of` may be this object
  /// only if `rates` is empty. Does not allocate if the memory suffices.
  void combine(double alpha, const boundary_budget& of, double beta, std::span<const double> rates,
               bool fresh);

 private:
  std::vector<double> amounts_;
};

}  // namespace apsis
