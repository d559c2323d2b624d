#pragma once

#include <apsis/steady/internal/frontal_factors.hpp>

#include <optional>

#include <Eigen/Core>

namespace apsis {

/// A pair of unit singular vectors of J for a singular value that is nearly 0. A shock between two uniform
/// states has such a mode, because hardly anything determines its position.
struct neutral_mode {
  Eigen::VectorXd left, right;

  /// r ← r without the part that J can reach only by a large change.
  void remove_from_right_side(Eigen::VectorXd& r) const { r -= left * left.dot(r); }
  /// x ← x without the mode.
  void remove_from_solution(Eigen::VectorXd& x) const { x -= right * right.dot(x); }
};

/// Returns the neutral mode of J, from a block inverse iteration. The smallest singular value must be below
/// 1/1000 of the next one. Returns nothing if J has no such mode, or several.
std::optional<neutral_mode> find_neutral_mode(const frontal_factors& factors);

}  // namespace apsis
