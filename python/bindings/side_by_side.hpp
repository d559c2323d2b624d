#pragma once

#include "callback.hpp"

#include <apsis/integrate/newton_problem.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace apsis::python {

/// Q, Q'x, Q''[k, x], whether a state is admissible as a stage, and the preconditioner of Krylov solvers.
struct collision_functions {
  callback collision, product, curvature;
  std::optional<callback> admissible, preconditioner;
};

/// Collisions that couple the numbers of a cell only, for functions of many cells. The stages of some hundred
/// cells are solved side by side: the solve of a cell is suspended when it needs a function, and the function
/// is called once for all cells that wait for it. The stages are bitwise those of cells that are solved one
/// after another, if the functions give a cell the same numbers whichever cells come with it.
class collisions_side_by_side {
 public:
  /// Cells have `length` unknowns. Arguments of the functions are arrays [cells, unknowns of a cell], and
  /// last the array of the indices of these cells; `admissible` returns a truth value for each cell. The
  /// functions must outlive the object.
  collisions_side_by_side(const collision_functions& of, std::size_t length, linear_solver solver);
  ~collisions_side_by_side();
  collisions_side_by_side(const collisions_side_by_side&) = delete;
  collisions_side_by_side& operator=(const collisions_side_by_side&) = delete;

  /// rate ← Q(u)
  void evaluate(const std::vector<double>& u, std::vector<double>& rate) const;
  /// Sets u ← v with v = u + a Q(v) + b Q'(v)Q(v). Throws numerical_error with the number of the first cell
  /// that has no solution; u is then unchanged.
  void solve(double t, double a, double b, std::vector<double>& u);
  /// Nothing is shared by the stages of a step.
  void begin_step(double, const std::vector<double>&) {}
  /// Returns whether all cells are admissible.
  bool are_admissible(const std::vector<double>& u) const;

 private:
  class slot;
  struct stacks;

  void solve_cells(std::size_t first, std::size_t count, double t, double a, double b,
                   std::vector<double>& u);
  void answer(const std::vector<slot*>& waiting) const;

  const collision_functions& of_;
  std::size_t length_;
  std::unique_ptr<stacks> stacks_;
  std::vector<std::unique_ptr<slot>> slots_;
};

}  // namespace apsis::python
