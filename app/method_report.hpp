#pragma once

#include <apsis/method/method.hpp>

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace apsis::app {

/// Returns the linear stability limits of cfl_limits() by reconstruction; null where any step is stable.
nlohmann::ordered_json cfl_json(const std::vector<std::pair<std::string, double>>& limits);

/// Returns the certificate of a method as `apsis check --json` prints it.
nlohmann::ordered_json check_json(const method& m);

/// Returns the certificate as text, with the failing conditions if a claim does not hold.
std::string check_text(const method& m);

/// Returns the first condition that does not hold; "" if all hold.
std::string first_failure(const method& m);

}  // namespace apsis::app
