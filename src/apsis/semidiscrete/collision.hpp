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

  /// In place u ← v with v = u + a Q(v)/ε + b Q̇(v)/ε², a = Δt d ≥ 0, b = Δt² ḋ ≤ 0, t the time of the stage;
  /// or the exact solution after a time a (stage_solution), for which b is 0. A relaxation keeps nonnegative
  /// rows so. Throws numerical_error with the cell where there is no solution.
  virtual void solve(double t, double a, double b, field& u) = 0;

  /// For each target: acc ← (fresh ? 0 : acc) + α u + β Q(u)/ε. Throws numerical_error where ε = 0.
  virtual void add_collision(double t, const field& u, std::span<const target<field, double>> targets) = 0;

  /// Returns the largest Δt for which u + Δt Q(u)/ε preserves what the collision preserves (for a relaxation
  /// min ε/C).
  virtual double forward_euler_step(const field& u) const = 0;

  /// Returns the thickness in time of the thinnest initial layer, the smallest ε/C > 0; +infinity if it is
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

/// A collision operator whose cells are independent of each other.
class cellwise_collision : public collision {
 public:
  cellwise_collision* as_cellwise() final { return this; }
  /// Allocates scratch memory for all threads of a loop whose body calls solve_cells().
  virtual void prepare(const field& u) = 0;
  /// Solves the stages of cells begin … end−1 on this thread.
  virtual void solve_cells(double a, double b, field& u, int begin, int end) = 0;
};

/// Returns the collision operator of point values, which is local to each cell. `epsilon` has one value per
/// cell. `keeps_sign` and `stages` as in batch_limits; `cells`: those of the gas, in increasing order, all if
/// there are none.
std::unique_ptr<collision> make_pointwise_collision(const model& equation, std::vector<double> epsilon,
                                                    bool keeps_sign = false,
                                                    std::vector<cell_range> cells = {},
                                                    stage_solution stages = stage_solution::implicit);

/// Returns the collision operator of cell averages in one space dimension: stages are solved at the three
/// Gauss–Legendre points of every cell, on the quartic through the reconstructed edges and the neighbouring
/// averages, with the (limited) values there; the new average is the weighted mean, which conserves exactly
/// even if ε varies within the cell. `epsilon` holds three values per cell, in the order of the points.
std::unique_ptr<collision> make_cell_average_collision(const model& equation, std::shared_ptr<domain> space,
                                                       limited_reconstruction edges,
                                                       std::vector<double> epsilon,
                                                       stage_solution stages = stage_solution::implicit);

/// Returns the collision operator of cell averages in one space dimension at the centres of cells: a stage
/// with explicit part ū solves v = p + a Q(v)/ε + b Q̇(v)/ε² at the centre of every cell, with the point
/// values p = P ū, and adds the averages of the change, ū + M (v − p) (centre_rows.hpp). Moments are
/// conserved whatever p is, since the rows v − p have none. Fourth order in space, of second order with an
/// error h/24 of the position in the cells at walls, where nothing passes. A third of the solves of Gauss
/// points, and the same equations at the same points for every Δt/ε, up to |I − P M|.
///
/// With `limited`, for methods that keep signs: nonnegative averages stay so. b = ū + v − p
/// is nonnegative, because p is reduced to ū in components where it would not be (v ≥ 0), and limited fluxes
/// between cells leave it so; each component on its own, so that the small numbers of the tails do not affect
/// the others. `epsilon` has one value per cell.
std::unique_ptr<collision> make_cell_centre_collision(const model& equation, std::shared_ptr<domain> space,
                                                      bool limited, std::vector<double> epsilon,
                                                      stage_solution stages = stage_solution::implicit);

}  // namespace apsis
