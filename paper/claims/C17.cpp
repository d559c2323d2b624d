#include <apsis/config/discretization_of_case.hpp>
#include <apsis/core/extremes.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/study/limit_distance.hpp>
#include <apsis/study/model_cases.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <paper/claim.hpp>
#include <paper/limit_convergence.hpp>

namespace apsis::paper {
namespace C17_claim {
namespace {

/// Bound of rounding: two programs sum in different order, over a few steps, values of order one.
constexpr double round_off = 1e-13;

const char* const papers_methods[] = {"md-imex-3-2", "md-imex-6-3"};

bool of_the_paper(const std::string& method) {
  return std::find(std::begin(papers_methods), std::end(papers_methods), method) != std::end(papers_methods);
}

/// Returns the IMEX methods of the catalogue whose certificate satisfies a condition.
template <class Condition>
std::vector<std::string> imex_methods(Condition wanted) {
  std::vector<std::string> names;
  for (const auto& name : method_names()) {
    const certificate& c = find_certificate(name);
    if (c.kind == method_kind::imex && wanted(c)) names.push_back(name);
  }
  return names;
}

constexpr double limit_row::* distances[] = {&limit_row::moments_first, &limit_row::moments_end,
                                             &limit_row::state_first, &limit_row::state_end};

/// Returns the smallest slope of the four distances. Distances that are rounding from the start have
/// no slope.
double smallest_slope(const limit_table& table) {
  double smallest = INFINITY;
  for (const auto column : distances) smallest = minimum(smallest, table.slope(column).value_or(INFINITY));
  return std::isinf(smallest) ? NAN : smallest;
}

double largest_floor(const limit_table& table) {
  double largest = 0.0;
  for (const auto column : distances) largest = maximum(largest, table.floor(column));
  return largest;
}

curve distance_curve(const limit_table& table, double limit_row::* column, const std::string& label,
                     curve_style style, int colour) {
  curve c{label, {}, {}, style, colour};
  for (const limit_row& row : table.rows) {
    c.x.push_back(row.epsilon);
    c.y.push_back(row.*column);
  }
  return c;
}

panel distance_panel(const std::string& title, const std::string& what) {
  return {title, "ε (dimensionless)", what + " (relative, dimensionless)", true, true, {}, {}, {}};
}

std::vector<double> epsilons() {
  auto values = geometric(1e-2, 1e-16, 15);
  values.push_back(0.0);
  return values;
}

// Decrease of the distance, for every model, every discretization and every method that promises it.

struct distance_job {
  std::string model, discretization, method;
  limit_table table = {};
};

std::vector<distance_job> all_distances(const study_control& control) {
  std::vector<distance_job> jobs;
  for (const auto& model : relaxation_model_names())
    for (const auto& discretization : formulation_names(model))
      for (const auto& method : imex_methods([](const certificate& c) { return c.ap_data == "any data"; }))
        jobs.push_back({model, discretization, method});
  run_all(control, "distances to the limit scheme", static_cast<int>(jobs.size()), [&](int k) {
    auto& job = jobs[static_cast<std::size_t>(k)];
    auto overrides = formulation_override(job.discretization);
    overrides.push_back("time.method=" + job.method);
    job.table = limit_distance(small_case(job.model, overrides), epsilons());
  });
  return jobs;
}

void judge_distances(const std::vector<distance_job>& jobs, claim_result& result) {
  std::vector<std::string> others;
  for (const auto& job : jobs) {
    if (!of_the_paper(job.method)) {
      if (std::find(others.begin(), others.end(), job.method) == others.end()) others.push_back(job.method);
      continue;
    }
    const std::string name = fmt::format("{}{}{}, {}", job.model, job.discretization.empty() ? "" : ", ",
                                         job.discretization, job.method);
    result.findings.push_back(
        at_least(name + ": slope of the distances in ε", smallest_slope(job.table), 0.9));
    result.findings.push_back(at_most(name + ": distances at ε = 0", largest_floor(job.table), round_off));
    result.tables.push_back(job.table.report());
  }
  for (const auto& method : others) {
    double slope = INFINITY, floor = 0.0;
    for (const auto& job : jobs) {
      if (job.method != method) continue;
      slope = minimum(slope, smallest_slope(job.table));
      floor = maximum(floor, largest_floor(job.table));
    }
    result.findings.push_back(at_least(method + ", all models: slope of the distances in ε", slope, 0.9));
    result.findings.push_back(at_most(method + ", all models: distances at ε = 0", floor, round_off));
  }
}

picture draw_distances(const std::vector<distance_job>& jobs) {
  picture p{
      "C17-distance",
      "Distance to the limit scheme, from inconsistent data",
      "Largest difference of the moments ω from those of the limit scheme at the end of eight steps, against "
      "ε at fixed step and mesh. It decreases in proportion to ε until only rounding remains. Solid: finite "
      "volumes (and the ODE model); dashed, coinciding up to rounding: finite differences.",
      {}};
  for (const auto& job : jobs) {
    if (!of_the_paper(job.method)) continue;
    if (p.panels.empty() || p.panels.back().title != job.model) {
      p.panels.push_back(distance_panel(job.model, "distance of ω"));
      p.panels.back().slopes = {1.0};
    }
    const bool dashed = job.discretization == "finite-difference";
    p.panels.back().curves.push_back(distance_curve(
        job.table, &limit_row::moments_end, job.method + (dashed ? ", finite differences" : ""),
        dashed ? curve_style::dashed_and_markers : curve_style::line_and_markers,
        job.method == papers_methods[0] ? 0 : 1));
  }
  return p;
}

/// Returns a case with pointwise equilibrium, so that consistent data are exactly consistent.
case_config pointwise_case(const std::string& model, const std::string& method, double step) {
  std::vector<std::string> overrides = {"time.method=" + method};
  if (model != "ode") overrides.emplace_back(discretization_override("finite-difference"));
  case_config config = small_case(model, overrides);
  *config.time.dt *= step;
  return config;
}

// Rate of the decrease: at least linear.

/// Checks the rate from data in equilibrium. Only stages without Q̇ then retain an O(ε) distance from
/// equilibrium. In md-imex-3-2 the only stage that enters T after a transport has Q̇ alone, so that the
/// distance of the moments decreases like ε². In md-imex-6-3 two such stages have Q alone.
void judge_rates(claim_result& result) {
  constexpr std::pair<const char*, double> rates[] = {{"md-imex-3-2", 2.0}, {"md-imex-6-3", 1.0}};
  for (const auto& [method, rate] : rates) {
    const auto table = limit_distance(pointwise_case("broadwell", method, 1.0), geometric(1e-3, 1e-6, 7),
                                      limit_start::equilibrium);
    result.findings.push_back(
        close_to(fmt::format("broadwell, {}, data in equilibrium: slope of the distance of ω", method),
                 table.slope(&limit_row::moments_end, round_off).value_or(NAN), rate, 0.1));
  }
}

// Failures: methods whose first or last stage is not relaxed.

/// Shows the failure of a method whose first stage is u^n itself.
void first_stage_failure(const std::string& model, const std::string& method, int colour, panel& into,
                         claim_result& result) {
  auto positive = epsilons();
  positive.pop_back();  // ε = 0 is undefined if Q(u^n)/ε is evaluated
  std::vector<double> plateau;
  for (const double step : {1.0, 0.5, 0.25}) {
    const auto table = limit_distance(pointwise_case(model, method, step), positive);
    plateau.push_back(table.floor(&limit_row::moments_first));
    if (step == 1.0)
      into.curves.push_back(
          distance_curve(table, &limit_row::moments_end, method, curve_style::line_and_markers, colour));
  }
  const auto consistent =
      limit_distance(pointwise_case(model, method, 1.0), positive, limit_start::equilibrium);
  into.curves.push_back(
      distance_curve(consistent, &limit_row::moments_end, "", curve_style::dashed_and_markers, colour));
  const std::string name = method + ", " + model;
  result.findings.push_back(
      at_least(name + ": distance of ω for ε → 0, data off equilibrium", plateau[0], 1e-4));
  result.findings.push_back(
      close_to(name + ": its order in Δt, first step", std::log2(plateau[1] / plateau[2]), 1.0, 0.1));
  result.findings.push_back(at_most(name + ": the same, data in equilibrium",
                                    consistent.floor(&limit_row::moments_end), round_off));
}

/// Shows the failure of a method whose last stage is not relaxed: the moments converge, but the state is
/// not projected.
void last_stage_failure(const std::string& model, const std::string& method, int colour, panel& into,
                        claim_result& result) {
  const auto table = limit_distance(pointwise_case(model, method, 1.0), epsilons());
  into.curves.push_back(
      distance_curve(table, &limit_row::moments_end, method, curve_style::line_and_markers, colour));
  into.curves.push_back(
      distance_curve(table, &limit_row::state_end, "", curve_style::dashed_and_markers, colour));
  const std::string name = method + ", " + model;
  result.findings.push_back(
      at_most(name + ": distance of ω at ε = 0", table.floor(&limit_row::moments_end), round_off));
  result.findings.push_back(
      at_least(name + ": distance of u from E(ω) at ε = 0", table.floor(&limit_row::state_end), 1e-6));
}

void show_failures(const study_control& control, claim_result& result) {
  const auto first = imex_methods([](const certificate& c) { return c.type == "ARS"; });
  const auto last = imex_methods([](const certificate& c) { return c.type == "A" && !c.gsa; });
  picture p{"C17-failures",
            "Effect of type A and GSA",
            "Left: methods whose first stage is u^n itself transport data that are off equilibrium. The "
            "distance of their moments is proportional to Δt (solid); only from data in equilibrium do they "
            "reach the limit scheme (dashed). Right: the moments of methods whose last stage is not relaxed "
            "reach the limit (solid), but the state remains off equilibrium (dashed).",
            {}};
  for (const std::string model : {"ode", "broadwell"}) {
    panel starts = distance_panel(model + ": first stage not relaxed", "distance of ω");
    panel ends = distance_panel(model + ": last stage not relaxed", "distance");
    for (std::size_t k = 0; k < first.size(); ++k) {
      control.check();
      first_stage_failure(model, first[k], static_cast<int>(k), starts, result);
    }
    for (std::size_t k = 0; k < last.size(); ++k) {
      control.check();
      last_stage_failure(model, last[k], static_cast<int>(k), ends, result);
    }
    if (!first.empty()) p.panels.push_back(std::move(starts));
    if (!last.empty()) p.panels.push_back(std::move(ends));
  }
  if (!p.panels.empty()) result.pictures.push_back(std::move(p));
}

claim_result check(const study_control& control) {
  claim_result result;
  const auto jobs = all_distances(control);
  judge_distances(jobs, result);
  judge_rates(result);
  result.pictures.push_back(draw_distances(jobs));
  show_failures(control, result);
  add_limit_convergence("C17", control, result);
  add_riemann_problems("C17", control, result);
  result.remarks = {
      "The distance decreases at least linearly, and no faster in general: the first stage of md-imex-3-2 "
      "has Q alone, so from inconsistent data it retains a part O(ε), which T transports.",
      "Methods of type CK are omitted: they evaluate Q(u^n)/ε explicitly, which leaves rounding divided by ε "
      "in the moments, also from data in equilibrium.",
      "Stages with cell averages relax at the Gauss points of the quartics through their explicit part, so "
      "the limit of the finite-volume scheme is a state of projected averages; its moments follow the "
      "explicit method."};
  return result;
}

}  // namespace
}  // namespace C17_claim

extern const claim_entry claim_C17;
const claim_entry claim_C17 = {
    .id = "C17",
    .section = "Properties of the numerical scheme, asymptotic preservation",
    .statement =
        "at fixed Δt, as ε → 0, the scheme becomes the explicit Runge–Kutta method on "
        "the limit system, for every model and from any data",
    .how =
        "comparison of runs with the limit scheme, implemented without the operators and the stepper of a "
        "run, and of the limit scheme with the limit systems written out by hand",
    .check = C17_claim::check};

}  // namespace apsis::paper
