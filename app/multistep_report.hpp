#pragma once

#include <apsis/method/multistep.hpp>

#include <string>

#include <nlohmann/json.hpp>

namespace apsis::app {

/// Returns the certificate of a multistep method as JSON, with the keys of check_json() that apply.
nlohmann::ordered_json multistep_json(const multistep_method& m);

/// Returns the certificate of a multistep method as text.
std::string multistep_text(const multistep_method& m);

}  // namespace apsis::app
