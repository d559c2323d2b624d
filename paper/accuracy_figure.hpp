#pragma once

#include <apsis/study/convergence.hpp>

#include <string>
#include <vector>

#include <paper/claim.hpp>

namespace apsis::paper {

/// Returns a picture of a study that varies time.method, model.epsilon and then the mesh or the step. As in
/// the paper, it has one panel per method and one curve per epsilon, the error against Δt.
picture accuracy_picture(const convergence_table& table, const std::string& name, const std::string& title,
                         const std::string& caption);

/// Returns a table of errors and slopes: one row per method and epsilon, one column per refinement.
report_table accuracy_table(const convergence_table& table, const std::string& title);

/// Returns the rows of one method and one epsilon, both as given to the study. Throws input_error if there
/// are no such rows.
const std::vector<convergence_row>& rows_of(const convergence_table& table, const std::string& method,
                                            const std::string& epsilon);

/// Returns the finding that the last `count` slopes are all within `tolerance` of `order`. Its value is the
/// slope farthest away.
finding slopes_near(const std::string& what, const std::vector<convergence_row>& rows, std::size_t count,
                    double order, double tolerance);

/// Returns the number of numerical failures in a study, as a finding that requires zero.
finding no_failures(const convergence_table& table);

}  // namespace apsis::paper
