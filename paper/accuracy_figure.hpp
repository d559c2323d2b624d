#pragma once

#include <paper/claim.hpp>
#include <apsis/verify/convergence.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Results of a study that varies time.method, model.epsilon and then the mesh or the step, as the paper
/// shows them: one panel for each method, one curve for each epsilon, error against Δt.
picture accuracy_picture(const convergence_table& table, const std::string& name, const std::string& title,
                         const std::string& caption);

/// Errors and slopes: a row for each method and epsilon, a column for each refinement.
report_table accuracy_table(const convergence_table& table, const std::string& title);

/// The rows of one method and one epsilon, both as they were given to the study. Throws input_error.
const std::vector<convergence_row>& rows_of(const convergence_table& table, const std::string& method,
                                            const std::string& epsilon);

/// Whether the last `count` slopes are all within `tolerance` of `order`; the value is the one farthest away.
finding slopes_near(const std::string& what, const std::vector<convergence_row>& rows, std::size_t count,
                    double order, double tolerance);

/// Numerical failures of the runs of a study, as a finding that there are none.
finding no_failures(const convergence_table& table);

}  // namespace apsis
