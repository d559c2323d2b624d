#pragma once

#include <apsis/method/method.hpp>

#include <string>

#include <nlohmann/json.hpp>

namespace apsis::app {

/// Returns the certificate of a two-step method as JSON, with the keys of check_json() that apply.
nlohmann::ordered_json two_step_json(const method& m);

/// Returns the certificate of a two-step method as text.
std::string two_step_text(const method& m);

}  // namespace apsis::app
