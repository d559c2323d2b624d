#pragma once

#include <apsis/config/case.hpp>
#include <apsis/model/model.hpp>

#include <vector>

namespace apsis {

/// Returns rows of the initial data of a case at points that do not depend on its mesh: 2048 on a line, 32 in
/// each of several directions. Throws input_error if the data have no row at a point.
std::vector<std::vector<double>> sample_data(const case_config& config, const model& equation);

}  // namespace apsis
