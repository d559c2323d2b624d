#pragma once

#include <apsis/method/method.hpp>

#include <nlohmann/json_fwd.hpp>

namespace apsis::app {

/// The certificate of a method as `apsis check --json` prints it.
nlohmann::ordered_json check_json(const method& m);

/// The certificate in words, with the failing conditions if a claim does not hold.
std::string check_text(const method& m);

/// The first condition that does not hold; "" if all hold.
std::string first_failure(const method& m);

}  // namespace apsis::app
