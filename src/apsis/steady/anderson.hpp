#pragma once

#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/field.hpp>

#include <deque>
#include <vector>

namespace apsis {

/// Anderson's mixture of the images g of a fixed-point iteration x → g: g ← g − Σ_j θ_j Δg_j with the θ that
/// minimize ‖r − Σ_j θ_j Δr_j‖₂ over the last differences. Source: Walker & Ni, SIAM J. Numer. Anal. 49,
/// 2011, with β = 1.
class anderson {
 public:
  /// `depth`: differences that it remembers.
  explicit anderson(int depth) : depth_(depth) {}

  /// Mixes an image with those of the calls before; `r`: any linear function of g − x, always the same, on
  /// the root of the processes that share g. Collective.
  void mix(communicator& processes, std::vector<double> r, field& g);
  /// Forgets all images.
  void clear();

 private:
  std::vector<double> shares(const std::vector<double>& r) const;

  int depth_;
  bool known_ = false;
  field last_image_;
  std::vector<double> last_r_;
  std::deque<field> changes_;
  std::deque<std::vector<double>> changes_of_r_;  ///< on the root
};

}  // namespace apsis
