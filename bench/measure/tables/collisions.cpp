// Throughput of the collision models of a gas relative to BGK without internal variables.
#include "../clock.hpp"
#include "../mixed_step.hpp"
#include "../table.hpp"

#include <apsis/config/discretization_of_case.hpp>

#include <deque>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::collisions_table {
namespace {

struct gas {
  std::string model;
  int velocity_dimensions, degrees_of_freedom;
};

/// Returns a case with wavy data on a periodic interval. It has 150 velocities in one dimension, and enough
/// for T = 1 in more.
case_config case_of(const gas& what, const std::string& discretization, int cells) {
  const std::vector<std::string> points = {"150", "[20, 20]", "[16, 16, 16]"};
  return load_case(
      "gas/sod",
      {"title=waves", "space.boundary=periodic", "initial.rho=\"1 + 0.2*sin(2*pi*x)\"",
       "initial.region.1.rho=\"1 + 0.1*cos(2*pi*x)\"", "initial.T=1", "initial.region.1.T=1",
       "model.name=" + what.model, fmt::format("model.velocity_dimensions={}", what.velocity_dimensions),
       fmt::format("model.degrees_of_freedom={}", what.degrees_of_freedom), "time.method=md-imex-6-3",
       discretization_override(discretization), fmt::format("space.cells={}", cells), "velocity.max=7",
       "velocity.points=" + points[static_cast<std::size_t>(what.velocity_dimensions - 1)]});
}

void add_rows(result_table& result, const std::vector<gas>& gases, const std::string& discretization,
              const settings& options) {
  const int cells = options.quick ? 10 : 100;
  std::deque<mixed_step> all;
  for (const gas& what : gases) all.emplace_back(case_of(what, discretization, cells));
  std::vector<job> jobs;
  std::vector<double> point_stages;
  for (mixed_step& one : all) {
    const int steps = one.steps_in(options.quick ? 0.002 : 0.04);
    jobs.push_back([&one, steps] { one.take(steps); });
    point_stages.push_back(steps * one.point_stages());
  }
  const auto seconds = in_turns(jobs, options.quick ? 1 : 5 * options.repeats);
  for (std::size_t k = 0; k < gases.size(); ++k) {
    const double ratio = median_ratio(seconds, 0, k) * point_stages[k] / point_stages[0];
    result.rows.push_back({gases[k].model, gases[k].velocity_dimensions, gases[k].degrees_of_freedom,
                           gases[k].degrees_of_freedom > gases[k].velocity_dimensions ? "g, h" : "f",
                           discretization, point_stages[k] / median(seconds[k]),
                           fmt::format("{:.2f}", ratio)});
  }
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Collision models of a gas";
  result.note =
      "The table shows point·stages per second of md-imex-6-3 with the limiter, 100 cells and one "
      "thread. A point is a number of the row of a cell, so that (g, h) has two for each velocity. The "
      "ratio is that to the first model of its group, in the same turns.";
  result.columns = {"model", "d", "D", "row", "formulation", "point·stages/s", "ratio"};
  for (const char* discretization : {"finite-difference", "finite-volume"}) {
    add_rows(result, {{"bgk", 1, 1}, {"bgk", 1, 3}, {"shakhov", 1, 3}, {"es-bgk", 1, 3}}, discretization,
             options);
    add_rows(result, {{"bgk", 2, 2}, {"bgk", 2, 3}, {"shakhov", 2, 3}, {"es-bgk", 2, 3}}, discretization,
             options);
    add_rows(result, {{"bgk", 3, 3}, {"shakhov", 3, 3}, {"es-bgk", 3, 3}}, discretization, options);
  }
  return result;
}

const registered here({"collisions", "speed of Shakhov, ES-BGK and reduced distributions against BGK",
                       measure});

}  // namespace
}  // namespace apsis::bench::collisions_table
