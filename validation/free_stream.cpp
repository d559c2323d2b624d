#include <validation/free_stream.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/run/body_loads.hpp>

#include <cmath>

#include <fmt/format.h>

namespace apsis::validation {

std::vector<quantity_parameter> free_stream_parameters() {
  return {{"mach", "2", "Mach number of the stream, 0.5 to 8"},
          {"quantity", "drag", "drag or heat"},
          {"accommodation", "1", "fraction of the molecules that is re-emitted, 0 to 1"}};
}

double speed_of_stream(const quantity_values& parameters) {
  return number_between(parameters, "mach", 0.5, 8.0) * std::sqrt(5.0 / 3.0);
}

double load_in_stream(const simulation& run, const std::string& wanted) {
  for (const load_value& one :
       loads_in_stream(body_loads(run.setup(), run.last()).front(), run.config().output.reference.value()))
    if (one.name == wanted) return one.value;
  throw input_error(fmt::format("the case \"{}\" has no {}", run.config().title, wanted));
}

double free_stream_coefficient(const std::string& case_name, const std::vector<std::string>& resolution,
                               const quantity_values& parameters, const quantity_run& make) {
  const double U = speed_of_stream(parameters);
  const bool drag = one_of(parameters, "quantity", {"drag", "heat"}) == "drag";
  static_cast<void>(number_between(parameters, "accommodation", 0.0, 1.0));
  std::vector<std::string> overrides = resolution;
  overrides.insert(overrides.end(),
                   {"parameters.M=" + parameters.at("mach"), "parameters.Kn=1e9",
                    "parameters.alpha=" + parameters.at("accommodation"),
                    fmt::format("velocity.max={}", U + 4.4), "time.method=md-imex-5-2", "output.every=0"});
  return load_in_stream(make(case_name, overrides), drag ? "C_D" : "C_H");
}

}  // namespace apsis::validation
