#include "design_options.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/design/more_stages.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/method/time_integrator.hpp>

#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

namespace apsis::app {
namespace {

template <class Value>
Value choice(const std::string& option, const std::string& given,
             const std::map<std::string, Value>& values) {
  const auto found = values.find(given);
  if (found != values.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, unused] : values) names.push_back(name);
  throw input_error(fmt::format("command line: unknown {} '{}' (there is no such choice); {}", option,
                                given.substr(0, 60), suggest(given, names)));
}

void require(bool good, const std::string& option, const std::string& value, const std::string& range) {
  if (!good)
    throw input_error(
        fmt::format("command line: {} {} is out of range ({}); change it", option, value, range));
}

int needed(const std::optional<int>& value, const std::string& option) {
  if (!value)
    throw input_error(
        fmt::format("command line: {} is missing (apsis design needs it); see: apsis design --help", option));
  return *value;
}

shu_osher_form<double> initial_form(const design_task& task, const std::string& name) {
  if (task.steps == 2) {
    const time_integrator& m = find_integrator(name);
    return m.steps == 2 && m.file() != nullptr
               ? m.form
               : with_previous_value(find_method(name).coefficients<double>());
  }
  return find_method(name).coefficients<double>();
}

void set_initial_method(design_task& task, const design_options& given) {
  const bool of_two_steps = task.steps == 2 && find_integrator(given.from).steps == 2;
  if (!of_two_steps) {
    const method& m = find_method(given.from);
    if (m.kind != task.kind || m.is_tableau() || m.ends_with_update())
      throw input_error(
          fmt::format("command line: --from '{}' cannot be improved (it is not {} of the paper's class); "
                      "name another method",
                      given.from, to_string(task.kind)));
  }
  task.from = initial_form(task, given.from);
  const int has = schedule(*task.from).transport_evaluations();
  require(given.evaluations == 0 || given.evaluations >= has, "--evaluations",
          std::to_string(given.evaluations), fmt::format("'{}' has {}: as many, or more", given.from, has));
}

void check_two_steps(const design_task& task, const design_options& given) {
  const auto refuse = [](const std::string& what, const std::string& why,
                         const std::string& advice = "change it") {
    throw input_error(
        fmt::format("command line: {} cannot be combined with --steps 2 ({}); {}", what, why, advice));
  };
  if (given.implicit) refuse("--implicit", "two-step methods are IMEX methods");
  if (task.demands.regime == regime_demand::all)
    refuse("--regime all", "the initial layer lies in the first steps, which a one-step method takes",
           "use --regime slow");
  if (given.demands.least_angle > 0.0) refuse("--angle", "it is implemented for one-step methods only");
  if (task.from && task.from->stages() > task.stages)
    refuse("fewer --stages than --from has", "stages are removed from one-step methods only");
}

}  // namespace

design_task task_of(const design_options& given) {
  const int order = needed(given.order, "--order"), stages = needed(given.stages, "--stages");
  require(order >= 1 && order <= 6, "--order", std::to_string(order), "from 1 to 6");
  require(stages >= 1 && stages <= 32, "--stages", std::to_string(stages), "from 1 to 32");
  require(given.evaluations >= 0 && given.evaluations < stages, "--evaluations",
          std::to_string(given.evaluations), "fewer than stages: the last stage is the result");
  require(given.steps == 1 || given.steps == 2, "--steps", std::to_string(given.steps), "1 or 2");
  require(given.starts >= 1, "--starts", std::to_string(given.starts), "at least 1");
  require(given.seconds > 0.0, "--time", fmt::format("{}", given.seconds), "positive, in seconds");
  const auto& d = given.demands;
  require(d.box > 0.0 && d.box <= 1e3, "--box", fmt::format("{}", d.box), "positive, at most 1000");
  require(d.margin >= 0.0 && d.margin < d.box, "--margin", fmt::format("{}", d.margin), "from 0 to the box");
  require(d.least_angle >= 0.0 && d.least_angle <= 90.0, "--angle", fmt::format("{}", d.least_angle),
          "from 0 to 90 degrees");
  require(d.least_pole >= 0.0 && d.least_pole * d.least_pole * d.margin <= 1.0, "--pole",
          fmt::format("{}", d.least_pole),
          fmt::format("from 0 to 1/sqrt(margin) = {:.4g}", 1.0 / std::sqrt(d.margin)));
  require(d.most_buffers >= 1, "--buffers", std::to_string(d.most_buffers), "at least 1");
  require(d.least_r > 0.0 && d.least_r < d.largest_r, "--ssp", fmt::format("{}", d.least_r),
          fmt::format("positive, below {}", d.largest_r));
  require(given.band_weight >= 0.0 && given.band_weight <= 1e6, "--band-weight",
          fmt::format("{}", given.band_weight), "from 0 to 1e6");
  require(given.sparsify >= 0.0 && given.sparsify < 1.0, "--sparsify", fmt::format("{}", given.sparsify),
          "from 0 to 1: the admissible loss of the objective");
  design_task task;
  task.kind = given.implicit ? method_kind::implicit_only : method_kind::imex;
  task.steps = given.steps;
  task.stages = static_cast<std::size_t>(stages + given.steps - 1);
  if (given.evaluations > 0) task.transports = given.evaluations;
  task.demands = d;
  task.demands.order = order;
  task.demands.regime = choice<regime_demand>(
      "--regime", given.regime,
      {{"none", regime_demand::none}, {"slow", regime_demand::slow}, {"all", regime_demand::all}});
  task.objective = choice<design_objective>("--objective", given.objective,
                                            {{"r", design_objective::largest_r},
                                             {"r/n_F", design_objective::efficiency},
                                             {"error", design_objective::smallest_error},
                                             {"band", design_objective::smallest_band},
                                             {"mixed", design_objective::smallest_mixed}});
  task.band_weight = given.band_weight;
  task.seed = given.seed;
  if (!given.from.empty()) set_initial_method(task, given);
  if (given.steps == 2) check_two_steps(task, given);
  if (!given.implicit) {
    require(stages >= 2, "--stages", std::to_string(stages),
            "an IMEX method needs 2; use --implicit for a method without transport");
    return task;
  }
  if (given.evaluations > 0 || given.regime != "none")
    throw input_error(
        "command line: --evaluations and --regime cannot be combined with --implicit (there is no "
        "transport); leave them out");
  // Without transport r is undefined.
  task.objective = design_objective::smallest_error;
  return task;
}

}  // namespace apsis::app
