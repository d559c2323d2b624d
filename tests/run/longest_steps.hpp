#pragma once

#include <apsis/config/case.hpp>
#include <apsis/run/setup.hpp>

#include <string>

#include <fmt/format.h>

/// Returns the override that gives a case steps of r Δt_FE times `factor`, shorter by rounding. They are the
/// longest with f ≥ 0. time.safety = 1 gives shorter steps if these are not linearly stable.
inline std::string steps_of_positivity(const std::string& text, double factor = 1.0) {
  const apsis::run_setup setup(apsis::parse_case(text, "random.toml"));
  const double step = setup.make_problem()->forward_euler_step(0.0, setup.initial_state());
  return fmt::format("time.cfl={:.17g}",
                     (1.0 - 1e-14) * factor * setup.ssp_coefficient() * step / setup.cfl_length());
}
