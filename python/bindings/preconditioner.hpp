#pragma once

#include "arrays.hpp"
#include "callback.hpp"

#include <apsis/integrate/stage_preconditioner.hpp>

#include <span>

namespace apsis::python {

/// The function r ↦ x that a preconditioner of Python returned, on arrays of one axis.
inline shifted_solve<double> solver_of(const py::object& made) {
  return [solve = callback(made.cast<py::function>(), "the solver of preconditioner")](
             std::span<const double> r, std::span<double> x) {
    const auto n = static_cast<py::ssize_t>(r.size());
    solve.numbers(solve(to_fixed_array(r, {n})), {n}, x);
  };
}

}  // namespace apsis::python
