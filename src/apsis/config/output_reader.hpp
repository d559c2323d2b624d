#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>

namespace apsis {

/// Reads the lists of tables [[output.probe]] and [[output.slice]] of a case whose mesh is known. Checks the
/// points of output.distribution_at and the names of output.surfaces. Throws input_error at the place of a
/// key that is unknown, missing, of a wrong type, not inside the domain, or that conflicts with another.
void read_output_tables(const case_text& text, const model_entry& model, case_config& config);

}  // namespace apsis
