#pragma once

#include <apsis/config/case.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Checks the name of a solid box or a body, the key `name` of the table at `path`. A name is a letter, then
/// letters, digits, - and _. Throws input_error at the place of the key for any other text. Also throws it
/// for the name of a face, for `all_surfaces` or one of `balance_terms`, and for one of the `earlier` names.
void check_surface_name(const case_config& config, const std::string& path, const std::string& name,
                        const std::vector<std::string>& earlier);

}  // namespace apsis
