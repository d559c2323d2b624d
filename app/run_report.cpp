#include "build_info.hpp"
#include "run_report.hpp"

#include <apsis/model/model_registry.hpp>
#include <apsis/output/case_json.hpp>

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

using json = nlohmann::ordered_json;

bool has_entropy(const simulation& run) {
  return !std::isnan(run.initial_record().entropy);
}

json numbers(const simulation& run) {
  const run_summary s = run.summary();
  json out = {{"steps", s.steps},
              {"startup_steps", s.startup_steps},
              {"rejected_steps", s.rejected_steps},
              {"dt", s.dt},
              {"t", s.t},
              {"wall_s", s.wall_s}};
  if (!find_model(run.config().model.name)->has_space) out["state"] = run.state();
  out["min_value"] = s.min_value;
  out["negative_values"] = s.negative_values;
  out["conservation_defect"] = s.conservation_defect;
  out["max_entropy_increase"] = has_entropy(run) ? json(s.max_entropy_increase) : json(nullptr);
  out["phase_points"] = s.phase_points;
  out["point_stages_per_s"] = s.point_stages_per_s;
  return out;
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

json to_json(const simulation& run, const run_records& records) {
  json out = {{"case", apsis::to_json(run.config())}, {"method", run.config().time.method}};
  out.update(numbers(run));
  json fields = json::object();
  const field_series& series = records.fields();
  if (!series.x.empty()) fields["x"] = series.x;
  if (!series.snapshots.empty())
    for (std::size_t k = 0; k < series.names.size(); ++k)
      fields[series.names[k]] = series.snapshots.back().values[k];
  out["fields"] = fields;
  return out;
}

json manifest(const simulation& run, run_end end, const std::string& message) {
  json out = {{"apsis", version()}, {"state", to_string(end)}};
  if (!message.empty()) out["message"] = message;
  out["written"] = time_stamp();
  out["case"] = apsis::to_json(run.config());
  out["method"] = run.config().time.method;
  out["promises"] = {{"positivity", run.promises().positivity},
                     {"conservation", run.promises().conservation},
                     {"entropy", run.promises().entropy}};
  out["result"] = numbers(run);
  out["build"] = build_info();
  out["machine"] = machine_info();
  return out;
}

std::string summary_text(const simulation& run, run_end end) {
  const run_summary s = run.summary();
  const case_config& c = run.config();
  std::string out = fmt::format("{}\n", c.title.empty() ? c.source : c.title);
  const auto line = [&out](const std::string& name, const std::string& value) {
    out += fmt::format("  {:<22}{}\n", name, value);
  };
  line("state",
       fmt::format("{} at t = {:.10g} after {} steps of {}", to_string(end), s.t, s.steps, c.time.method));
  if (s.startup_steps > 0)
    line("start-up", s.startup_steps == 1 ? "not needed (no layer is thinner than the first step)"
                                          : fmt::format("{} steps instead of 1", s.startup_steps));
  if (c.time.tolerance)
    line("tolerance", fmt::format("{:g} ({} steps rejected)", *c.time.tolerance, s.rejected_steps));
  line("largest step", fmt::format("{:.6g}", s.dt));
  line("smallest value", fmt::format("{:.6g} ({} negative)", s.min_value, s.negative_values));
  if (!run.invariants().empty())
    line("conservation defect", fmt::format("{:.2e} (relative)", s.conservation_defect));
  if (has_entropy(run)) line("max entropy increase", fmt::format("{:.2e}", s.max_entropy_increase));
  if (!find_model(c.model.name)->has_space) {
    std::string values;
    for (const double x : run.state()) values += fmt::format("{}{:.17g}", values.empty() ? "" : "  ", x);
    line("solution", values);
  }
  line("wall time", fmt::format("{:.2f} s ({:.3g} point stages per second)", s.wall_s, s.point_stages_per_s));
  return out;
}

}  // namespace apsis::app
