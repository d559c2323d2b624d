// Cost of flows per unit of time at the longest steps of methods that have the right terms of size ε.
#include "../clock.hpp"
#include "../table.hpp"

#include <apsis/config/case.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/method.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::transit_table {
namespace {

/// The method that the others are compared with.
constexpr const char* usual = "md-imex-8-3-mixed";

/// Returns the methods of order two and more that have an SSP coefficient, for the promise f ≥ 0, and the
/// right terms of size ε.
std::vector<std::string> competitors(bool quick) {
  if (quick) return {usual, "md-imex-5-2"};
  std::vector<std::string> all;
  for (const std::string& name : method_names()) {
    const certificate& c = find_certificate(name);
    if (c.kind == method_kind::imex && c.order >= 2 && c.keeps_slow_terms && c.ssp_coefficient > 0.0)
      all.push_back(name);
  }
  return all;
}

case_config with_longest_steps(const std::string& name, const std::string& method) {
  case_config of = load_case(name);
  of.time.method = method;
  of.time.dt.reset();
  of.time.cfl.reset();
  of.time.tolerance.reset();
  of.time.safety = 1.0;
  of.time.steady.reset();
  of.time.end = 1e9;
  of.output.every = 0.0;
  return of;
}

/// A flow with each of several methods.
class race {
 public:
  race(const std::string& flow, const std::vector<std::string>& methods) {
    for (const std::string& method : methods) {
      runs_.push_back(std::make_unique<simulation>(with_longest_steps(flow, method)));
      runs_.back()->advance();  // allocates the buffers
    }
  }

  /// Returns the CPU time per unit of time of the flow for each method, relative to the usual one.
  std::vector<double> costs(std::size_t of_usual, const settings& options) {
    const double span = span_of(options.quick ? 0.001 : 0.2);
    std::vector<job> jobs;
    std::vector<int> steps;
    for (const auto& run : runs_) {
      steps.push_back(static_cast<int>(std::ceil(span / run->dt())));
      jobs.emplace_back([&run = *run, count = steps.back()] {
        for (int k = 0; k < count; ++k) run.advance();
      });
    }
    const auto seconds = in_turns(jobs, options.quick ? 1 : options.repeats);
    const auto lasts = [&](std::size_t k) { return steps[k] * runs_[k]->dt(); };
    std::vector<double> costs;
    for (std::size_t k = 0; k < runs_.size(); ++k)
      costs.push_back(median_ratio(seconds, k, of_usual) * lasts(of_usual) / lasts(k));
    return costs;
  }

 private:
  /// Returns the time of the flow that the first run covers in about `seconds`.
  double span_of(double seconds) {
    const double start = wall_seconds();
    runs_.front()->advance();
    return runs_.front()->dt() * std::max(1.0, seconds / (wall_seconds() - start));
  }

  std::vector<std::unique_ptr<simulation>> runs_;
};

result_table measure(const settings& options) {
  result_table result;
  result.title = "Flows at the longest steps";
  result.note =
      "Steps are as long as the SSP coefficient and linear stability with weno5-z let them be. A step takes "
      "s "
      "solves and n_F sweeps. The table shows both for the time in which the fastest molecule passes a cell. "
      "It shows the CPU time of flows for equal times, relative to md-imex-8-3-mixed, on one thread. All "
      "methods have the right terms of size ε (docs/plateaus.md). The band is the largest error of the "
      "viscous "
      "flux where ε ~ Δt, relative to Δt.";
  const std::vector<std::string> flows =
      options.quick ? std::vector<std::string>{"gas/sod"}
                    : std::vector<std::string>{"gas/sod", "gas/couette", "gas/poiseuille", "gas/cavity"};
  result.columns = {"method", "p", "s", "n_F", "CFL number", "s per transit", "n_F per transit", "band"};
  for (const std::string& flow : flows) result.columns.push_back(flow);
  result.columns.emplace_back("mean");
  set_threads(1);
  const auto methods = competitors(options.quick);
  const auto of_usual =
      static_cast<std::size_t>(std::find(methods.begin(), methods.end(), usual) - methods.begin());
  std::vector<std::vector<double>> costs;
  for (const std::string& flow : flows) costs.push_back(race(flow, methods).costs(of_usual, options));
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const certificate& c = find_certificate(methods[k]);
    const simulation tube(with_longest_steps("gas/sod", methods[k]));
    const double number = std::min(static_cast<double>(c.ssp_coefficient), tube.setup().stability_limit());
    const auto stages = find_method(methods[k]).stages();
    std::vector<nlohmann::json> row = {methods[k],
                                       c.order,
                                       stages,
                                       c.explicit_evaluations,
                                       fmt::format("{:.3g}", number),
                                       fmt::format("{:.2f}", static_cast<double>(stages) / number),
                                       fmt::format("{:.2f}", c.explicit_evaluations / number),
                                       fmt::format("{:.2g}", c.band.error)};
    double product = 1.0;
    for (const auto& of_flow : costs) {
      row.emplace_back(fmt::format("{:.2f}", of_flow[k]));
      product *= of_flow[k];
    }
    row.emplace_back(fmt::format("{:.2f}", std::pow(product, 1.0 / static_cast<double>(costs.size()))));
    result.rows.push_back(std::move(row));
  }
  return result;
}

const registered here({"transit",
                       "flows at the longest steps of methods with the right terms of size epsilon",
                       measure});

}  // namespace
}  // namespace apsis::bench::transit_table
