#include "command_registry.hpp"
#include "integrator_report.hpp"
#include "interrupt.hpp"
#include "method_report.hpp"
#include "method_writer.hpp"
#include "print.hpp"
#include "progress_bar.hpp"
#include "threads_option.hpp"
#include "with_design/design_embedded.hpp"
#include "with_design/design_options.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/design/draw.hpp>
#include <apsis/design/fewer_stages.hpp>
#include <apsis/design/finish.hpp>
#include <apsis/design/search.hpp>
#include <apsis/design/sparsify.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/method/integrator_kind_registry.hpp>

#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace design_command {
namespace {

using json = nlohmann::ordered_json;
using clock = std::chrono::steady_clock;

std::string state_of(const design_progress& p) {
  const std::string best =
      p.best ? fmt::format("r {:.6f}, error {:.4g}{}", p.best->r, p.best->error,
                           p.best->band > 0.0 ? fmt::format(", 2-norm of the band {:.3g}", p.best->band) : "")
             : fmt::format("nearest residual {:.1e}", p.best_residual);
  return fmt::format("{} starts, {} feasible, {}", p.starts, p.feasible, best);
}

json summary(const design_task& task, const design_options& given, const design_progress& found,
             double wall) {
  return {
      {"kind", to_string(task.kind)},
      {"order", task.demands.order},
      {"steps", task.steps},
      {"stages", *given.stages},
      {"box", task.demands.box},
      {"objective", given.objective},
      {"seed", task.seed},
      {"starts", found.starts},
      {"feasible", found.feasible},
      {"nearest_residual", std::isfinite(found.best_residual) ? json(found.best_residual) : json(nullptr)},
      {"wall_s", wall},
      {"found", found.best.has_value()}};
}

/// Removes stages from the initial method until the requested number is left, and writes each method on the
/// way. Returns false if it was stopped before.
bool take_stages_out(design_task& task, method_writer& file, const std::function<bool()>& stop) {
  while (task.from && task.from->stages() > task.stages) {
    const std::size_t stages = task.from->stages();
    double least = std::numeric_limits<double>::infinity();
    auto smaller = without_a_stage(task, *task.from, stop, [&](std::size_t stage, double left) {
      least = std::min(least, left);
      log::info(fmt::format("{} stages: weights of stage {} down to {:.2g}", stages, stage + 1, left));
    });
    if (stop()) return false;
    if (!smaller)
      throw numerical_error(
          fmt::format("no stage of {} can be removed (least sum of weights {:.2g}); try another initial "
                      "method, a larger box or a smaller --ssp",
                      stages, least));
    task.from = std::move(smaller);
    design_task on_the_way = task;
    on_the_way.stages = task.from->stages();
    design_problem problem(pattern_near(on_the_way, *task.from), task.demands);
    file.write(to_method(on_the_way, drop_zeros(problem, problem.unknowns_of(*task.from)), file.name()));
  }
  return true;
}

method unpolished(const design_task& task, const design_candidate& candidate, const std::string& name) {
  return task.steps == 2 ? to_polished_two_step_method(task, candidate, name, 15)
                         : to_method(task, candidate, name);
}

int design(const design_options& given) {
  if (!given.embedded.empty())
    return design_embedded({given.embedded, given.order, given.cost, given.out, given.json});
  design_task task = task_of(given);
  method_writer file(given.out);
  watch_for_interrupts("the current iteration; the best method so far remains in its file");
  set_threads(given.threads.value_or(default_threads()));
  const auto begin = clock::now();
  const auto elapsed = [&begin] { return std::chrono::duration<double>(clock::now() - begin).count(); };
  const auto stop = [&] { return interrupted() || elapsed() > given.seconds; };
  if (!take_stages_out(task, file, stop)) {
    if (interrupted()) return static_cast<int>(exit_code::interrupted);
    throw numerical_error(
        fmt::format("a method of {} stages remains (the time of {:.0f} s is over); give more --time",
                    task.from->stages(), elapsed()));
  }
  progress_bar bar;
  design_search_options limits;
  limits.starts = given.starts;
  limits.stop = stop;
  limits.report = [&](const design_progress& p, bool improved) {
    if (improved) file.write(unpolished(task, *p.best, file.name()));
    const double part = std::max(static_cast<double>(p.starts) / given.starts, elapsed() / given.seconds);
    bar.update(part, state_of(p));
  };
  const design_progress found = search_methods(task, limits);
  bar.finish();
  json result = summary(task, given, found, elapsed());
  if (!found.best) {
    if (given.json) print(result.dump(2) + "\n");
    if (interrupted()) return static_cast<int>(exit_code::interrupted);
    throw numerical_error(
        fmt::format("no method found ({} in {:.0f} s, seed {}); try more starts, stages or a larger box",
                    state_of(found), elapsed(), task.seed));
  }
  if (interrupted()) {
    log::warning(fmt::format("interrupted; the best method so far is in '{}'", file.path()));
    return static_cast<int>(exit_code::interrupted);
  }
  auto best = *found.best;
  if (given.sparsify > 0.0) best = sparsify(task, best, given.sparsify, interrupted);
  const method polished = task.steps == 2 ? to_polished_two_step_method(task, best, file.name())
                                          : to_polished_method(task, best, file.name());
  const auto certified = integrator_of_file(polished);
  file.write(polished);
  result["start"] = best.start;
  result["error_constant"] = best.error;
  result["file"] = file.path();
  result["method"] = integrator_json(*certified);
  if (given.json) {
    print(result.dump(2) + "\n");
  } else {
    print(fmt::format("{}; best of start {}; written to '{}'\n\n{}", state_of(found), best.start, file.path(),
                      integrator_text(*certified)));
  }
  if (!result["method"]["claims_hold"].get<bool>())
    throw claim_error(fmt::format("the method in '{}' does not meet the demands ({}); try another seed",
                                  file.path(), result["method"]["failures"].front().get<std::string>()));
  return 0;
}

action define(CLI::App& command) {
  auto given = std::make_shared<design_options>();
  auto& d = given->demands;
  command.add_option("--order", given->order, "order of accuracy, or that of the embedded solution");
  command.add_option("--stages", given->stages, "number of stages; the last one is the result");
  command
      .add_option("--steps", given->steps,
                  "1, or 2: stages also depend on the value and the transport one step earlier")
      ->capture_default_str();
  command.add_flag("--implicit", given->implicit, "a method without transport, u' = Q(u)");
  command.add_option("--evaluations", given->evaluations, "transport evaluations per step (default: any)");
  command.add_option("--box", d.box, "largest d and |ddot|")->capture_default_str();
  command.add_option("--margin", d.margin, "least d + |ddot| of a stage")->capture_default_str();
  command
      .add_option("--objective", given->objective, "quantity to optimize: r, r/n_F, error, band, or mixed")
      ->capture_default_str();
  command
      .add_option("--band-weight", given->band_weight,
                  "weight of band and layer relative to the error (band, mixed)")
      ->capture_default_str();
  command.add_option("--ssp", d.least_r, "least SSP coefficient r")->capture_default_str();
  command.add_option("--from", given->from,
                     "a method (name or FILE.toml) to improve instead of random starts; stages above "
                     "--stages are removed, stages and evaluations below the requested numbers are added");
  command
      .add_option("--regime", given->regime, "terms of size epsilon required to be exact: none, slow or all")
      ->capture_default_str();
  command.add_option("--angle", d.least_angle, "least angle of A(alpha)-stability, degrees");
  command.add_option("--pole", d.least_pole, "least distance from zero of poles on the imaginary axis");
  command.add_option("--buffers", d.most_buffers, "largest number of state-sized buffers");
  command.add_option("--sparsify", given->sparsify, "part of the objective to trade for fewer coefficients");
  command.add_option("--starts", given->starts, "random starts")->capture_default_str();
  command.add_option("--time", given->seconds, "time limit of the search in seconds")->capture_default_str();
  command.add_option("--seed", given->seed, "seed of the random starts")->capture_default_str();
  add_threads(command, given->threads, "threads to use", "all processors");
  command.add_option("--out", given->out, "method file to write (FILE.toml)")->required();
  command.add_flag("--json", given->json, "print one JSON object");
  CLI::Option* embedded = command.add_option(
      "--embedded", given->embedded, "find an embedded solution of this method (name or FILE.toml) instead");
  for (CLI::Option* option : command.get_options())
    if (!option->check_lname("order") && !option->check_lname("out") && !option->check_lname("json") &&
        !option->check_lname("help") && option != embedded)
      embedded->excludes(option);
  command.add_option("--cost", given->cost, "solves of the embedded solution per step: nothing or one-solve")
      ->needs(embedded)
      ->capture_default_str();
  return [given] { return design(*given); };
}

}  // namespace
}  // namespace design_command

extern const command_entry command_design;
const command_entry command_design = {
    .name = "design",
    .summary = "Find a new method of given order and stages that optimizes an objective",
    .place = 70,
    .define = design_command::define};

}  // namespace apsis::app
