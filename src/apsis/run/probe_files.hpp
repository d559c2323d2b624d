#pragma once

#include <apsis/config/case.hpp>
#include <apsis/output/field_series.hpp>
#include <apsis/output/result_folder.hpp>

namespace apsis {

/// Adds probes/NAME.csv and slices/NAME.h5, slices/NAME.xdmf of the tables [[output.probe]] and
/// [[output.slice]] to the results. `unit_of_length`: that of the axes of the fields in units of the case.
/// Throws io_error.
void write_probes(const case_config& config, const field_series& fields, double unit_of_length,
                  result_folder& folder);

}  // namespace apsis
