#pragma once

#include <apsis/integrate/problem.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/sweep.hpp>

#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// The collision operator Q(u)/ε of a model on a mesh.
class collision {
 public:
  virtual ~collision() = default;

  /// In place u ← v with v = u + a Q(v)/ε + b Q̇(v)/ε², a = Δt d ≥ 0, b = Δt² ḋ ≤ 0, t the time of the stage.
  /// A relaxation keeps nonnegative rows so. Throws numerical_error with the cell where there is no solution.
  virtual void solve(double t, double a, double b, field& u) = 0;

  /// For each target: acc ← (fresh ? 0 : acc) + α u + β Q(u)/ε. Throws numerical_error where ε = 0.
  virtual void add_collision(double t, const field& u, std::span<const target<field, double>> targets) = 0;

  /// Largest Δt for which u + Δt Q(u)/ε keeps what the collision keeps (for a relaxation: min ε/C).
  virtual double forward_euler_step(const field& u) const = 0;

  /// Width in time of the thinnest initial layer: smallest ε/C > 0. +infinity where none is known, or ε = 0
  /// everywhere.
  virtual double relaxation_time(const field& u) const = 0;
};

/// A collision of which every cell can be solved without its neighbours.
class cellwise_collision : public collision {
 public:
  /// Makes scratch space ready for all threads of a loop whose body calls solve_cells().
  virtual void prepare(const field& u) = 0;
  /// solve() for cells begin … end−1, on this thread.
  virtual void solve_cells(double a, double b, field& u, int begin, int end) = 0;
};

/// Point values: every cell on its own. `epsilon` per cell. `keeps_sign` as in model::make_collision().
std::unique_ptr<collision> make_pointwise_collision(const model& equation, std::vector<double> epsilon,
                                                    bool keeps_sign = false);

/// Cell averages in one space dimension: stages are solved at the three Gauss–Legendre points of every cell,
/// on the quartic through the reconstructed edges and the neighbouring averages, with the (limited) values
/// there; the new average is the weighted mean. Conserves exactly although ε varies inside the cell.
/// `epsilon` holds three values per cell, in the order of the points.
std::unique_ptr<collision> make_cell_average_collision(const model& equation, std::shared_ptr<domain> space,
                                                       stencil how, std::vector<double> epsilon);

}  // namespace apsis
