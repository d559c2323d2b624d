#pragma once

#include <apsis/config/case.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

namespace apsis {

/// Initial data from a file.
struct state_of_file {
  field state;  ///< on the mesh of the case
  /// Whether all of it is the distribution of an earlier result, which ran on the same velocities.
  bool from_result = false;
};

/// Returns the initial state of a case with `initial.file`, with its regions on top.
///
/// The file is an earlier result (solution.h5, fields.csv), or a table with x and the variables of a form of
/// the model (data_form) as cell averages on equal cells. Of an earlier result with the same velocities the
/// distribution is used, otherwise the equilibrium with the moments of its fields. A parabola in each cell of
/// the file (cell_polynomials) is averaged over the cells of the mesh, or evaluated at their centres: third
/// order; averages of averages keep the totals of the conserved quantities to rounding. On the mesh of the
/// result its distribution is used bit for bit.
///
/// Throws input_error at the place of the key: a file that cannot be read, of another model or other units,
/// without a column, with a value from which no row can be made, or that does not cover the domain.
state_of_file sample_initial_file(const case_config& config, const model& equation,
                                  const problem_builder& builder);

}  // namespace apsis
