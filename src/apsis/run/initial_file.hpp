#pragma once

#include <apsis/config/case.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

namespace apsis {

/// Initial data from a file.
struct state_of_file {
  field state;  ///< on the mesh of the case
  /// Whether `state` is entirely the distribution of an earlier result on the same velocities.
  bool from_result = false;
};

/// Returns the initial state of a case with `initial.file`. Regions of the case override
/// the data of the file.
///
/// The file is an earlier result (solution.h5, fields.csv), or a table of cell averages on equal cells. A
/// table has x and the variables of a form of the model (data_form). An earlier result with the same
/// velocities contributes its distribution, any other file the equilibrium with the moments of its fields.
///
/// A parabola in each cell of the file (cell_polynomials) is averaged over the cells of the mesh, or
/// evaluated at their centres. The interpolation has third order. Averages of averages conserve the totals to
/// rounding. On the mesh of the result, its distribution is used bit for bit.
///
/// Throws input_error at the place of the key if the file cannot be read, has another model or other units,
/// or lacks a column. It also throws if values do not make a row, or if the file does not cover the domain.
state_of_file sample_initial_file(const case_config& config, const model& equation,
                                  const problem_builder& builder);

}  // namespace apsis
