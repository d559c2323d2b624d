#pragma once

#include <apsis/steady/internal/frontal_factors.hpp>

#include <optional>

#include <Eigen/Core>

namespace apsis {

/// A pair of singular vectors of J whose singular value is nearly 0, of length 1. A shock between two uniform
/// states has one: hardly anything decides where it stands.
struct neutral_mode {
  Eigen::VectorXd left, right;

  /// r ← r without the part that J can only reach by a large change.
  void remove_from_right_side(Eigen::VectorXd& r) const { r -= left * left.dot(r); }
  /// x ← x without the mode.
  void remove_from_solution(Eigen::VectorXd& x) const { x -= right * right.dot(x); }
};

/// Returns the neutral mode of J, from a block inverse iteration: the smallest singular value must be below a
/// thousandth of the next. Returns nothing if J has none, or has several.
std::optional<neutral_mode> find_neutral_mode(const frontal_factors& factors);

}  // namespace apsis
