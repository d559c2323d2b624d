#include <apsis/run/manifest.hpp>

#include <apsis/config/case_json.hpp>
#include <apsis/core/version.hpp>
#include <apsis/method/method_choice.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/output/provenance.hpp>
#include <apsis/run/body_loads.hpp>
#include <apsis/run/found_walls.hpp>
#include <apsis/run/result_units.hpp>

#include <cmath>

#include <nlohmann/json.hpp>

namespace apsis {
namespace {

using json = nlohmann::ordered_json;

/// Returns numbers in row-major order as nested lists of a shape.
json nested(const std::vector<double>& values, const std::vector<std::uint64_t>& shape) {
  std::vector<json> items(values.begin(), values.end());
  for (std::size_t k = shape.size(); k-- > 1;) {
    std::vector<json> outer;
    for (std::size_t first = 0; first < items.size(); first += shape[k]) {
      const auto begin = items.begin() + static_cast<std::ptrdiff_t>(first);
      outer.emplace_back(json::array_t(begin, begin + static_cast<std::ptrdiff_t>(shape[k])));
    }
    items = std::move(outer);
  }
  return items;
}

json numbers(const simulation& run) {
  const run_summary s = run.summary();
  json out;
  run_summary::visit_members(s, [&out](const char* name, const auto& x) { out[name] = x; });
  const result_units units(run.config());
  for (const char* time : {"t", "dt"}) out[time] = out[time].get<double>() * units.factor(units.of_time());
  out["velocity_needed"] = s.velocity_needed * units.factor(dimensions::velocity);
  if (std::isnan(run.initial_record().entropy)) out["max_entropy_increase"] = nullptr;
  if (run.initial_record().cut.empty()) out["largest_cut"] = nullptr;
  if (!has_space(find_model(run.config().model.name))) out["state"] = run.state();
  return out;
}

/// Adds the progress of the iteration to a steady state, in a case with a table [steady].
void add_iterations(json& out, const simulation& run) {
  const auto& tolerance = run.config().steady_state.tolerance;
  if (!tolerance || run.last().residual.empty()) return;
  const auto number = [](double x) { return std::isfinite(x) ? json(x) : json(nullptr); };
  out["steady"] = {{"reached", run.finished()},
                   {"tolerance", *tolerance},
                   {"iterations", run.step()},
                   {"residual", number(run.last().residual.front())},
                   {"change", number(run.last().change)},
                   {"removed_values", run.last().removed.count},
                   {"smallest_removed", run.last().removed.lowest}};
}

/// Adds the estimate of the distance from the steady state, in a case with time.steady.
void add_steady(json& out, const simulation& run, const steady_estimate& estimate) {
  if (!run.config().time.steady) return;
  const double time = result_units(run.config()).factor(dimensions::time);
  const auto number = [](double x) { return std::isfinite(x) ? json(x) : json(nullptr); };
  out["steady"] = {{"reached", estimate.change <= *run.config().time.steady},
                   {"change", number(estimate.change / time)},
                   {"decay_time", number(estimate.decay_time * time)},
                   {"distance", number(estimate.distance)}};
}

/// Adds force, torque and heat of the bodies in the last step, in the units of the results. With reference
/// values it also adds drag, lift, moment and the coefficients.
void add_bodies(json& out, const simulation& run) {
  const result_units units(run.config());
  const auto& reference = run.config().output.reference;
  for (const body_load& body : body_loads(run.setup(), run.last())) {
    dimension force = dimensions::pressure;
    for (int k = 1; k < run.mesh().dimensions_of_integrals(); ++k) force = force * dimensions::length;
    const auto scaled = [&](std::vector<double> values, const dimension& dims) {
      for (double& x : values) x *= units.factor(dims);
      return values;
    };
    json one = {{"force", scaled(body.force, force)},
                {"torque", scaled(body.torque, force * dimensions::length)},
                {"heat", body.heat * units.factor(force * dimensions::velocity)}};
    if (reference)
      for (const load_value& value : loads_in_stream(body, *reference))
        one[value.name] = value.value * units.factor(value.dims);
    out["bodies"][body.name] = one;
  }
}

/// Adds the mean temperatures of found_walls(), at bodies and at sides of the domain.
void add_wall_temperatures(json& out, const simulation& run) {
  const double kelvin = result_units(run.config()).factor(dimensions::temperature);
  const auto walls = found_walls(run.setup());
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const double T = run.last().wall_temperature.at(k) * kelvin;
    out[walls[k].is_side ? "sides" : "bodies"][walls[k].name]["T_w"] =
        std::isfinite(T) ? json(T) : json(nullptr);
  }
}

/// Adds the scales of a gas and, if results are in SI units, the units of history, surfaces and fields.
void add_units(json& out, const simulation& run) {
  const auto& scales = run.config().scales;
  if (!scales) return;
  out["scales"] = apsis::to_json(*scales);
  if (!result_units(run.config()).are_si()) return;
  json names = json::object();
  for (int k = 0; k < run.mesh().dimensions(); ++k)
    names[std::string(1, "xyz"[k])] = unit_of(dimensions::length);
  for (const auto& one : history_units(run)) names[one.column] = one.unit;
  for (const surface_table& surface : run.surfaces())
    for (std::size_t k = 0; k < surface.dimensions.size(); ++k)
      names[surface.numbers.columns[k]] = unit_of(surface.dimensions[k]);
  const field_table fields = run.fields();
  for (std::size_t k = 0; k < fields.names.size(); ++k)
    names[fields.names[k]] = unit_of(fields.dimensions[k]);
  out["units"] = names;
}

/// Adds the reason of the choice, if the program chose the method.
void add_choice(json& out, const case_config& config) {
  if (config.time.method_reason.empty()) return;
  out["method_given"] = automatic_method;
  out["method_reason"] = config.time.method_reason;
}

}  // namespace

std::string to_string(run_end end) {
  switch (end) {
    case run_end::complete:
      return "complete";
    case run_end::interrupted:
      return "interrupted";
    case run_end::wall_time:
      return "wall time reached";
    case run_end::failed:
      return "failed";
  }
  return "";
}

json to_json(const simulation& run, const run_records& records, const std::vector<std::string>& warnings) {
  json out = {{"case", apsis::to_json(run.config())}, {"method", run.config().time.method}};
  add_choice(out, run.config());
  out.update(numbers(run));
  out["expected_plateau"] = run.expected_plateau();
  out["expected_loss"] = run.expected_loss();
  add_iterations(out, run);
  add_steady(out, run, estimate_steady_state(records.history()));
  add_bodies(out, run);
  add_wall_temperatures(out, run);
  json fields = json::object();
  const field_series series = result_units(run.config()).convert(records.fields());
  for (const auto& axis : series.axes) fields[axis.name] = axis.centres;
  const auto shape = mesh_shape(series.axes);
  if (!series.snapshots.empty())
    for (std::size_t k = 0; k < series.names.size(); ++k)
      fields[series.names[k]] = nested(series.snapshots.back().values[k], shape);
  out["fields"] = fields;
  add_units(out, run);
  out["warnings"] = warnings;
  return out;
}

json manifest(const simulation& run, const session_record& session) {
  json out = {{"apsis", version()}, {"commit", commit()}, {"state", to_string(session.end)}};
  if (!session.message.empty()) out["message"] = session.message;
  if (!session.command.empty()) out["command"] = session.command;
  if (session.restart) out["restart"] = *session.restart;
  out["started"] = session.started;
  out["written"] = time_stamp();
  out["case"] = apsis::to_json(run.config());
  out["method"] = run.config().time.method;
  add_choice(out, run.config());
  out["promises"] = {{"positivity", run.promises().positivity},
                     {"conservation", run.promises().conservation},
                     {"entropy", run.promises().entropy}};
  if (!run.promises().condition.empty()) out["promises"][run.promises().condition] = true;
  out["result"] = numbers(run);
  add_iterations(out["result"], run);
  add_steady(out["result"], run, session.steady);
  add_bodies(out["result"], run);
  add_wall_temperatures(out["result"], run);
  add_units(out, run);
  out["warnings"] = session.warnings;
  out["build"] = build_info();
  out["machine"] = machine_info();
  out["machine"]["host"] = host_name();
  return out;
}

}  // namespace apsis
