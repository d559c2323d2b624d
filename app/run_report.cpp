#include "run_report.hpp"
#include "scales_text.hpp"

#include <apsis/model/model_registry.hpp>
#include <apsis/model/velocity_support.hpp>
#include <apsis/run/body_loads.hpp>
#include <apsis/run/found_walls.hpp>
#include <apsis/run/result_units.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis::app {

namespace {

/// Describes how well the velocity grid supports the gas.
std::string velocities_text(const run_summary& s, const case_config& c) {
  std::string text =
      fmt::format("at most {:.2g} of the mass of a Maxwellian beyond their ends", s.velocity_beyond);
  if (s.velocity_missed > velocity_limits::good) {
    text += fmt::format(", {:.2g} of its energy missed", s.velocity_missed);
    const result_units units(c);
    if (s.velocity_needed > 0.0)
      text += fmt::format(" (velocities up to {:.4g}{} would do)",
                          s.velocity_needed * units.factor(dimensions::velocity),
                          units.suffix(dimensions::velocity));
  }
  if (c.force.acceleration)
    text += fmt::format(
        "; the force moved {:.2g} of the mass into the last ones and lost at most {:.2g} of its momentum and "
        "{:.2g} of its energy",
        s.velocity_held, s.force_lost_momentum, s.force_lost_energy);
  return text;
}

}  // namespace

std::string summary_text(const simulation& run, run_end end, const run_records& records) {
  const run_summary s = run.summary();
  const case_config& c = run.config();
  std::string out = fmt::format("{}\n", c.title.empty() ? c.source : c.title);
  const auto line = [&out](const std::string& name, const std::string& value) {
    out += fmt::format("  {:<21} {}\n", name, value);
  };
  const result_units units(c);
  const double time = units.factor(units.of_time());
  const std::string of_time = units.suffix(units.of_time());
  const bool iterates = c.steady_state.tolerance.has_value();
  if (iterates) {
    line("state", fmt::format("{} after {} iterations", to_string(end), s.steps));
    line(
        "steady state",
        fmt::format("{} (residual {:.2g} of that of the start, change of the moments {:.2g}, tolerance {:g})",
                    run.finished() ? "found" : "not found", run.last().residual.front(), run.last().change,
                    *c.steady_state.tolerance));
  } else {
    line("state", fmt::format("{} at t = {:.10g}{} after {} steps of {}", to_string(end), s.t * time, of_time,
                              s.steps, c.time.method));
  }
  if (s.startup_steps > 0)
    line("start-up", s.startup_steps == 1 ? "not needed (no layer is thinner than the first step)"
                                          : fmt::format("{} steps instead of 1", s.startup_steps));
  if (c.time.tolerance)
    line("tolerance", fmt::format("{:g} ({} steps rejected)", *c.time.tolerance, s.rejected_steps));
  if (c.time.steady)
    line("steady state", fmt::format("time.steady = {:g} {} ({})", *c.time.steady / time,
                                     run.last().change <= *c.time.steady ? "reached" : "not reached",
                                     to_text(estimate_steady_state(records.history()), time, of_time)));
  if (!iterates) line("largest step", fmt::format("{:.6g}{}", s.dt * time, of_time));
  line("smallest value", fmt::format("{:.6g} ({} negative)", s.min_value, s.negative_values));
  if (!run.setup().equation->invariants().empty())
    line(iterates ? "net rates" : "conservation defect",
         fmt::format("{:.2e} (relative)", s.conservation_defect));
  const auto faces = run.setup().open_faces(), names = run.setup().equation->invariants();
  const auto densities = run.setup().equation->invariant_dimensions();
  for (std::size_t f = 0; f < faces.size() && !names.empty(); ++f) {
    std::vector<std::string> amounts;
    for (std::size_t k = 0; k < names.size(); ++k) {
      const dimension flux = dimension_of_integral(densities[k], run.mesh()) / dimensions::time;
      amounts.push_back(fmt::format("{} {:.6g}{}", names[k],
                                    run.last().flux[f * names.size() + k] * units.factor(flux),
                                    units.suffix_of_amount(flux, lacking_directions(run.mesh()))));
    }
    const bool is_term =
        std::find(balance_terms.begin(), balance_terms.end(), faces[f]) != balance_terms.end();
    line(fmt::format("{} {}", is_term ? "given by the" : "flux through", faces[f]),
         fmt::format("{}", fmt::join(amounts, ", ")));
  }
  if (const auto& reference = c.output.reference)
    for (const body_load& body : body_loads(run.setup(), run.last())) {
      std::vector<std::string> coefficients;
      for (const load_value& one : loads_in_stream(body, *reference))
        if (one.dims == dimensions::none)
          coefficients.push_back(fmt::format("{} {:.6g}", one.name, one.value));
      line("coefficients", fmt::format("{} ({})", fmt::join(coefficients, ", "), body.name));
    }
  const auto walls = found_walls(run.setup());
  for (std::size_t k = 0; k < walls.size(); ++k)
    line("wall temperature",
         fmt::format("{:.6g}{} in the mean ({})",
                     run.last().wall_temperature.at(k) * units.factor(dimensions::temperature),
                     units.suffix(dimensions::temperature), walls[k].name));
  if (!iterates && !std::isnan(run.initial_record().entropy))
    line("max entropy increase", fmt::format("{:.2e}", s.max_entropy_increase));
  if (std::isfinite(s.velocity_room)) line("velocities", velocities_text(s, c));
  if (std::string moment = run.setup().equation->cut_moment(); !moment.empty()) {
    std::replace(moment.begin(), moment.end(), '_', ' ');
    line("cut of the target",
         fmt::format("{:.2e} (largest relative change of the rate at which the {} relaxes)", s.largest_cut,
                     moment));
  }
  if (!has_space(find_model(c.model.name))) {
    std::string values;
    for (const double x : run.state()) values += fmt::format("{}{:.17g}", values.empty() ? "" : "  ", x);
    line("solution", values);
  }
  if (c.scales) {
    std::istringstream scales(scales_text(*c.scales) +
                              knudsen_text(c.scales->epsilon(), c.scales->gas().viscosity_exponent));
    for (std::string text; std::getline(scales, text);) out += "  " + text + "\n";
  }
  line("wall time", fmt::format("{:.2f} s ({:.3g} point stages per second)", s.wall_s, s.point_stages_per_s));
  return out;
}

}  // namespace apsis::app
