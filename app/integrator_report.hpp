#pragma once

#include <apsis/method/time_integrator.hpp>

#include <string>

#include <nlohmann/json.hpp>

namespace apsis::app {

/// Returns the certificate of an integrator as JSON: check_json() of a method of one step, otherwise the
/// facts of its kind, with the same keys where they apply.
nlohmann::ordered_json integrator_json(const time_integrator& m);

/// Returns the certificate of an integrator as text.
std::string integrator_text(const time_integrator& m);

}  // namespace apsis::app
