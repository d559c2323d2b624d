#pragma once

#include <apsis/config/case.hpp>
#include <apsis/output/field_series.hpp>
#include <apsis/output/result_folder.hpp>

namespace apsis {

/// Adds probes/NAME.csv, slices/NAME.h5 and slices/NAME.xdmf to the results, for the tables
/// [[output.probe]] and [[output.slice]]. `unit_of_length` converts lengths of the case to those of the
/// axes of `fields`. Throws io_error.
void write_probes(const case_config& config, const field_series& fields, double unit_of_length,
                  result_folder& folder);

}  // namespace apsis
