#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// Returns the text of a JSON value; invalid UTF-8 (possible in file names) is replaced.
std::string json_text(const nlohmann::ordered_json& value);

}  // namespace apsis
