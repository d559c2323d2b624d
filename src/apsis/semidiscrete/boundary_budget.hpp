#pragma once

#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// Amounts of the invariants that a state has received through its surfaces, from a force, from the rotation
/// of axisymmetric flow and from a source.
/// Layout: [surface][end][invariant] over every end of a segment at a surface, in the order of
/// domain::budget_surfaces(), then the totals of a force, of the rotation and of a source, then the
/// force_losses. Empty where nothing was received; an empty budget counts as zeros.
class boundary_budget {
 public:
  boundary_budget() = default;
  /// Takes the amounts.
  explicit boundary_budget(std::vector<double> amounts) : amounts_(std::move(amounts)) {}

  const std::vector<double>& amounts() const { return amounts_; }  ///< in the layout of the class

  /// Starts again from zero; keeps the memory.
  void clear() { amounts_.clear(); }
  /// this ← factor · this.
  void scale(double factor);
  /// this ← this + factor · amounts; grows to their number.
  void add(double factor, std::span<const double> amounts);

  /// this ← (fresh ? 0 : this) + α of + β rates, the combination of a target of add_transport. `of` may be
  /// this object only if `rates` is empty. Does not allocate if the memory suffices.
  void combine(double alpha, const boundary_budget& of, double beta, std::span<const double> rates,
               bool fresh);

 private:
  std::vector<double> amounts_;
};

}  // namespace apsis
