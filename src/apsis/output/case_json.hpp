#pragma once

#include <apsis/config/case.hpp>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// The case as nested tables, with the keys that its model uses and "source".
nlohmann::ordered_json to_json(const case_config& config);

/// Text of a JSON value; bytes that are no UTF-8 (they can come from a file name) are replaced.
std::string json_text(const nlohmann::ordered_json& value);

}  // namespace apsis
