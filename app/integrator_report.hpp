#pragma once

#include <apsis/method/time_integrator.hpp>

#include <string>

#include <nlohmann/json.hpp>

namespace apsis::app {

/// Returns the certificate of an integrator as JSON. For a method of one step this is check_json(). Other
/// kinds have their own facts, with the same keys where they apply.
nlohmann::ordered_json integrator_json(const time_integrator& m);

/// Returns the certificate of an integrator as text.
std::string integrator_text(const time_integrator& m);

}  // namespace apsis::app
