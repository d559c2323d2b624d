#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace apsis::app {

/// Returns the table of `apsis list methods` from an array of results of check_json().
std::string method_table(const nlohmann::ordered_json& all);

}  // namespace apsis::app
