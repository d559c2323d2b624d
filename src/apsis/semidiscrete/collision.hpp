#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/limited_reconstruction.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

class cellwise_collision;

/// The collision operator Q(u)/ε of a model on a mesh.
class collision {
 public:
  virtual ~collision() = default;

  /// Returns this operator if its cells are independent of each other, null otherwise.
  virtual cellwise_collision* as_cellwise() { return nullptr; }

  /// In place u ← v with v = u + a Q(v)/ε + b Q̇(v)/ε², a = Δt d ≥ 0, b = Δt² ḋ ≤ 0; t is the time of the
  /// stage. For an exact stage_solution, v is the exact solution after the time a, and b is 0. A relaxation
  /// keeps rows nonnegative. Throws numerical_error with the cell if there is no solution.
  virtual void solve(double t, double a, double b, field& u) = 0;

  /// For each target: acc ← (fresh ? 0 : acc) + α u + β Q(u)/ε. Throws numerical_error if ε = 0.
  virtual void add_collision(double t, const field& u, std::span<const target<field, double>> targets) = 0;

  /// Returns the largest Δt for which u + Δt Q(u)/ε preserves what the collision preserves; for a relaxation
  /// it is min ε/C.
  virtual double forward_euler_step(const field& u) const = 0;

  /// Returns the smallest ε/C > 0, the duration of the thinnest initial layer. Returns +infinity if it is
  /// unknown or ε = 0 everywhere.
  virtual double relaxation_time(const field& u) const = 0;

  /// Returns the largest point_collision::take_cut() of all cells of this process.
  virtual double take_cut() = 0;
};

/// Returns the largest take_cut() of the solvers `local` of all threads.
template <class Scratch>
double take_largest_cut(per_thread<Scratch>& of_threads) {
  double largest = 0.0;
  of_threads.visit_all([&](Scratch& own) {
    if (own.local) largest = std::max(largest, own.local->take_cut());
  });
  return largest;
}

/// A collision operator with mutually independent cells.
class cellwise_collision : public collision {
 public:
  cellwise_collision* as_cellwise() final { return this; }
  /// Allocates scratch memory for all threads of a loop that calls solve_cells().
  virtual void prepare(const field& u) = 0;
  /// Solves the stages of cells begin … end−1 on this thread.
  virtual void solve_cells(double a, double b, field& u, int begin, int end) = 0;
};

/// Returns the collision operator of point values, which is local to each cell. `epsilon` has one value per
/// cell. `keeps_sign` and `stages` are those of batch_limits. `cells` are those of the gas in increasing
/// order; an empty list means all cells.
std::unique_ptr<collision> make_pointwise_collision(const model& equation, std::vector<double> epsilon,
                                                    bool keeps_sign = false,
                                                    std::vector<cell_range> cells = {},
                                                    stage_solution stages = stage_solution::implicit);

/// Returns the collision operator of cell averages in one space dimension. It solves stages at the three
/// Gauss–Legendre points of every cell. The (limited) values there lie on the quartic through the
/// reconstructed edges and the neighbouring averages. The new average is the weighted mean, which conserves
/// exactly even if ε varies within the cell. `epsilon` has three values per cell, in the order of the points.
/// Throws input_error for other dimensions.
std::unique_ptr<collision> make_cell_average_collision(const model& equation, std::shared_ptr<domain> space,
                                                       limited_reconstruction edges,
                                                       std::vector<double> epsilon,
                                                       stage_solution stages = stage_solution::implicit);

/// Returns the collision operator of cell averages in one space dimension at the centres of cells. A stage
/// with explicit part ū solves v = p + a Q(v)/ε + b Q̇(v)/ε² at the centre of every cell, with the point
/// values p = P ū. It then adds the averages of the change, ū + M (v − p) (centre_rows.hpp). Moments are
/// conserved for any p, since the rows v − p have none. The order in space is four. It is two in the cells at
/// walls, where no flux of M passes; this is equivalent to an error h/24 of the position. A stage needs a
/// third of the solves at Gauss points. For every Δt/ε it solves the same equations at the same points, up to
/// |I − P M|. Throws input_error for other dimensions.
///
/// With `limited`, for methods that keep signs, nonnegative averages stay nonnegative. b = ū + v − p is made
/// nonnegative: p is clipped to ū in components with b < 0, and v ≥ 0. The limited fluxes between cells
/// preserve b ≥ 0. Each component is limited separately, so that the small numbers of the tails do not affect
/// the others. `epsilon` has one value per cell.
std::unique_ptr<collision> make_cell_centre_collision(const model& equation, std::shared_ptr<domain> space,
                                                      bool limited, std::vector<double> epsilon,
                                                      stage_solution stages = stage_solution::implicit);

}  // namespace apsis
