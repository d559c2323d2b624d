#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace apsis {

/// A batch of points at which a collision is evaluated: rows of components() numbers, `pitch` numbers apart.
struct point_batch {
  int count = 0;                    ///< number of points
  std::ptrdiff_t pitch = 0;         ///< distance between rows; numbers beyond the components are padding
  const double* epsilon = nullptr;  ///< ε ≥ 0 at each point
  int first_cell = 0;               ///< cell of the first point, for error messages
  int points_per_cell = 1;          ///< consecutive points that share a cell, for error messages
  bool cached = false;              ///< whether the rows were just written; they cause no memory traffic then
};

/// Result of point_collision::solve_stage().
enum class stage_solution {
  implicit,  ///< v = u + a Q(v)/ε + b Q̇(v)/ε²
  exact      ///< v(a) of v' = Q(v)/ε, v(0) = u, for methods with exact collisions
};

/// Largest batch of a point_collision, and what its stages and error messages depend on.
struct batch_limits {
  int points = 1;            ///< most points of a batch
  std::ptrdiff_t pitch = 0;  ///< distance between rows, at least the number of components
  /// Whether steps within r Δt_FE keep nonnegative data nonnegative. Error messages then suggest such steps.
  bool keeps_sign = false;
  stage_solution stages = stage_solution::implicit;  ///< `exact` requires model::has_exact_collision()
};

/// The collision Q(u)/ε of a model at points of space: the stage solve, on which every method is built, and
/// Q/ε itself. An object owns the scratch memory of one thread. model::make_collision() constructs it. All
/// quantities are dimensionless.
class point_collision {
 public:
  virtual ~point_collision() = default;

  /// Solves the stage in place for the row of every point: u ← v with v = u + a Q(v)/ε + b Q̇(v)/ε², where Q̇
  /// = Q'Q, a ≥ 0 and b ≤ 0. With stage_solution::exact, v is the exact solution and b = 0. Throws
  /// numerical_error with the cell if a stage has no solution.
  virtual void solve_stage(double a, double b, const point_batch& at, double* u) = 0;
  /// Solves the stage at every point and computes weighted means over groups of weights.size() consecutive
  /// points: means ← Σ_q weights_q v_q. There is one row per group, at the same pitch. Overwrites the rows u.
  virtual void solve_stage_means(double a, double b, const point_batch& at, double* u,
                                 std::span<const double> weights, double* means);
  /// change ← v − u for every point, with v as in solve_stage(), at the same pitch. If v ≥ 0, then u + change
  /// ≥ 0 in floating point too.
  virtual void solve_stage_changes(double a, double b, const point_batch& at, const double* u,
                                   double* change);
  /// q ← Q(u)/ε for every point, at the same pitch. Throws numerical_error if ε = 0 or Q does not exist.
  virtual void evaluate(const point_batch& at, const double* u, double* q) = 0;

  /// Returns the largest relative change of the rate at which model::cut_moment() relaxes, over all stages
  /// and evaluations of Q since the last call; 0 by default.
  virtual double take_cut();

  /// Returns the largest Δt for which u + Δt Q(u)/ε preserves what the collision preserves, such as signs:
  /// ε/C for a relaxation. Returns 0 if it is unknown.
  virtual double forward_euler_step(const double* u, double epsilon);
  /// Returns the relaxation time ε/C, the width of the initial layer; +infinity if it is unknown or ε = 0.
  virtual double relaxation_time(const double* u, double epsilon);
};

/// Returns the number of points in a batch of rows of `width` numbers, from 2 to 64. The rows and as many
/// rows of scratch memory should fit into half of a first-level cache of 32 KiB.
inline int points_per_batch(int width) {
  return std::clamp(1024 / std::max(width, 1), 2, 64);
}

}  // namespace apsis
