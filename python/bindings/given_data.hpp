#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <string>
#include <vector>

#include <pybind11/pybind11.h>

namespace apsis::python {

namespace py = pybind11;

/// Returns the state that Python gives: an array [cells, components]; a function that returns the components
/// at a point, of the coordinates and, in a model with a velocity grid, of the velocities; or a dict of the
/// variables of a form of the model (data_form): numbers, functions of the coordinates, or arrays with a
/// value for each cell. Functions are averaged over cells as formulas of cases are; arrays of variables are
/// the averages, or point values, of cells. `name` is that of the argument, for messages; `jumps` are the
/// discontinuities of functions on a line, in increasing order. Throws input_error with the point or the
/// cell. Needs the GIL.
field make_state(const py::object& given, const model& equation, const problem_builder& builder,
                 const std::vector<double>& jumps, const std::string& name);

}  // namespace apsis::python
