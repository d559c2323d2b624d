#pragma once

#include <apsis/config/case.hpp>

#include <nlohmann/json_fwd.hpp>

namespace apsis {

/// Returns the case as nested tables with the keys that its model uses, and "source".
nlohmann::ordered_json to_json(const case_config& config);

/// Returns the gas and its quantities(), each with "value" and "unit".
nlohmann::ordered_json to_json(const gas_scales& scales);

}  // namespace apsis
