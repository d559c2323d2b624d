#pragma once

#include "cases.hpp"

#include <apsis/integrate/extrapolation.hpp>
#include <apsis/run/setup.hpp>

#include <cmath>

/// Runs the ODE model to t = 1 and returns |Δu1| + |Δu2| relative to an extrapolated solution.
inline double error_at_one(const apsis::case_config& c) {
  apsis::simulation run(c);
  finish(run);
  const apsis::run_setup setup(c);
  const auto problem = setup.make_problem();
  apsis::field u = setup.initial_state();
  apsis::extrapolate(*problem, u, 0.0, 1.0, {1e-11}, [](const apsis::field& a, const apsis::field& b) {
    return std::max(std::abs(a.row(0)[0] - b.row(0)[0]), std::abs(a.row(0)[1] - b.row(0)[1]));
  });
  return std::abs(run.state()[0] - u.row(0)[0]) + std::abs(run.state()[1] - u.row(0)[1]);
}

/// Runs to the end and returns the state, the step sizes and all records, for comparisons.
inline std::vector<std::vector<double>> rest_of(apsis::simulation& run) {
  std::vector<std::vector<double>> all;
  while (!run.finished()) {
    const auto& r = run.advance();
    auto row = run.state();
    row.insert(row.end(), {static_cast<double>(r.step), r.t, r.dt, r.min_value, run.summary().dt,
                           static_cast<double>(run.summary().rejected_steps)});
    all.push_back(row);
  }
  return all;
}
