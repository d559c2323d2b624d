#include <paper/limit_convergence.hpp>

#include <apsis/config/discretization_of_case.hpp>
#include <apsis/method/certificate.hpp>

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <paper/limit_solution.hpp>

namespace apsis::paper {
namespace {

struct smooth_problem {
  std::string base, title;
  std::vector<std::string> overrides;
  std::vector<double> sizes;  ///< cells, or steps without space
  bool has_space = true;

  case_config configure(const std::string& discretization, const std::string& method, double size) const {
    auto all = overrides;
    all.push_back("time.method=" + method);
    if (has_space) {
      all.push_back(discretization_override(discretization));
      all.push_back(fmt::format("space.cells={}", size));
    } else {
      all.push_back(fmt::format("time.dt={:.17g}", 1.0 / size));
    }
    return load_case(base, all);
  }
};

std::vector<smooth_problem> smooth_problems() {
  return {{"paper/ode", "u1' = sin u1", {"time.end=1"}, {16, 32, 64, 128, 256}, false},
          {"paper/broadwell", "Broadwell limit system", {"space.reconstruction=weno5-z"}, {40, 80, 160, 320}},
          {"paper/relaxation",
           "Burgers' equation from the relaxation system",
           {"space.reconstruction=weno5-z"},
           {40, 80, 160, 320}},
          {"paper/bgk-accuracy",
           "Euler equations from BGK",
           {"space.reconstruction=weno5-z", "velocity.points=60", "velocity.max=12"},
           {40, 80, 160}}};
}

struct convergence_series {
  std::size_t problem;
  std::string discretization, method;
  std::vector<double> errors = {};
};

std::string series_name(const smooth_problem& p, const convergence_series& s) {
  return p.title + (p.has_space ? ", " + s.discretization : "") + ", " + s.method;
}

std::vector<convergence_series> all_series(const std::vector<smooth_problem>& problems) {
  std::vector<convergence_series> series;
  for (std::size_t k = 0; k < problems.size(); ++k)
    for (const char* discretization : {"finite-volume", "finite-difference"})
      for (const char* method : {"md-imex-3-2", "md-imex-6-3"})
        if (problems[k].has_space || discretization == std::string("finite-volume"))
          series.push_back({k, discretization, method, std::vector<double>(problems[k].sizes.size())});
  return series;
}

/// Computes all errors, the largest runs first for load balance.
void run_series(const std::vector<smooth_problem>& problems, std::vector<convergence_series>& series,
                const study_control& control) {
  std::vector<fourier_solution> exact;
  for (const auto& p : problems)
    exact.push_back(limit_solution(p.configure("finite-volume", "md-imex-6-3", p.sizes.front())));
  std::vector<std::pair<std::size_t, std::size_t>> jobs;
  for (std::size_t back = 1; back <= 8; ++back)
    for (std::size_t s = 0; s < series.size(); ++s)
      if (back <= series[s].errors.size()) jobs.emplace_back(s, series[s].errors.size() - back);
  run_all(control, "convergence to the limit systems", static_cast<int>(jobs.size()), [&](int job) {
    const auto [s, k] = jobs[static_cast<std::size_t>(job)];
    const auto& p = problems[series[s].problem];
    series[s].errors[k] =
        distance_from_limit_solution(p.configure(series[s].discretization, series[s].method, p.sizes[k]),
                                     exact[series[s].problem], control);
  });
}

report_table table_of(const std::vector<smooth_problem>& problems,
                      const std::vector<convergence_series>& series) {
  report_table table{
      "Runs with ε = 0 against the written-out limit systems: relative L2 error, order to the next finer",
      {"limit system", "formulation", "method", "cells or steps", "error", "order"},
      {}};
  for (const auto& s : series) {
    const auto& p = problems[s.problem];
    for (std::size_t k = 0; k < s.errors.size(); ++k)
      table.rows.push_back(
          {p.title, p.has_space ? s.discretization : "", s.method, fmt::format("{}", p.sizes[k]),
           fmt::format("{:.3e}", s.errors[k]),
           k + 1 < s.errors.size() ? fmt::format("{:.2f}", std::log2(s.errors[k] / s.errors[k + 1])) : ""});
  }
  return table;
}

}  // namespace

void add_limit_convergence(const std::string& id, const study_control& control, claim_result& result) {
  const auto problems = smooth_problems();
  auto series = all_series(problems);
  run_series(problems, series, control);

  picture drawing{
      id + "-convergence",
      "Runs with ε = 0 converge to the limit systems",
      "Relative L2 error of the moments against solutions of the limit systems by Fourier collocation, which "
      "is independent of kinetic schemes. Solid: finite volumes; dashed, nearly indistinguishable: finite "
      "differences. The second-order method has slope 2, the third-order method a slope above 3 until the "
      "fifth-order spatial error is the smaller one.",
      {}};
  for (const auto& p : problems)
    drawing.panels.push_back({p.title,
                              p.has_space ? "cell size (dimensionless)" : "Δt (dimensionless)",
                              "relative error (dimensionless)",
                              true,
                              true,
                              {},
                              {},
                              {2.0, 3.0}});
  for (const auto& s : series) {
    const auto& p = problems[s.problem];
    const int order = find_certificate(s.method).order;
    const std::size_t last = s.errors.size() - 1;
    result.findings.push_back(at_least(series_name(p, s) + ": order of convergence at ε = 0",
                                       std::log2(s.errors[last - 1] / s.errors[last]), order - 0.15));
    const bool dashed = s.discretization == "finite-difference";
    curve c{s.method + (dashed ? ", finite differences" : ""),
            {},
            s.errors,
            dashed ? curve_style::dashed_and_markers : curve_style::line_and_markers,
            order - 2};
    for (const double size : p.sizes) c.x.push_back((p.has_space ? 2.0 : 1.0) / size);
    drawing.panels[s.problem].curves.push_back(std::move(c));
  }
  result.tables.push_back(table_of(problems, series));
  result.pictures.push_back(std::move(drawing));
}

void add_riemann_problems(const std::string& id, const study_control& control, claim_result& result) {
  constexpr std::array<const char*, 2> cases = {"paper/broadwell-riemann-1", "paper/broadwell-riemann-2"};
  constexpr std::array<const char*, 2> titles = {"one shock", "rarefaction and shock"};
  constexpr std::array<int, 3> cells = {400, 200, 100};  // largest first
  std::array<std::array<riemann_comparison, 3>, 2> runs;
  run_all(control, "Riemann problems", 6, [&](int job) {
    const auto k = static_cast<std::size_t>(job % 2), n = static_cast<std::size_t>(job / 2);
    runs[k][n] = compare_with_riemann_solution(load_case(cases[k], {fmt::format("space.cells={}", cells[n])}),
                                               control);
  });
  picture drawing{id + "-riemann",
                  "Broadwell model, Riemann problems with ε = 0",
                  "Density and momentum on 200 cells (markers) and the exact solution of the limit system "
                  "(black). The shocks have the correct positions and extend over a handful of cells.",
                  {}};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const auto& run = runs[k][1];
    drawing.panels.push_back(
        {titles[k], "x (dimensionless)", "density ρ, momentum m (dimensionless)", false, false, {}, {}, {}});
    auto& curves = drawing.panels.back().curves;
    curves.push_back({"ρ", run.x, run.rho, curve_style::markers, 0});
    curves.push_back({"m", run.x, run.m, curve_style::markers, 1});
    curves.push_back({"exact", run.x, run.rho_exact, curve_style::line, -2});
    curves.push_back({"", run.x, run.m_exact, curve_style::line, -2});
    // The order is one at a jump. Single halvings vary with the position of the shock inside its cell, so
    // that two are combined.
    result.findings.push_back(
        at_least(fmt::format("Riemann problem, {}: order in L1 from {} to {} cells, ε = 0", titles[k],
                             cells[2], cells[0]),
                 0.5 * std::log2(runs[k][2].error / runs[k][0].error), 0.5));
    result.findings.push_back(
        at_most(fmt::format("Riemann problem, {}: relative L1 error on {} cells, ε = 0", titles[k], cells[0]),
                runs[k][0].error, 5e-3));
  }
  result.pictures.push_back(std::move(drawing));
}

}  // namespace apsis::paper
