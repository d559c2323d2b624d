#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace apsis::app {

/// Table of `apsis list methods` from an array of objects of check_json.
std::string method_table(const nlohmann::ordered_json& all);

}  // namespace apsis::app
