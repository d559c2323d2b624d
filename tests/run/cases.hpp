#pragma once

#include <apsis/model/model_registry.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <string>
#include <vector>

/// Returns the paper's mixed-regime case with some keys changed.
inline apsis::case_config mixed(const std::string& data, const std::string& method, const std::string& how) {
  apsis::case_config c;
  c.model.name = "bgk";
  const apsis::model_config defaults = apsis::default_config(apsis::find_model("bgk"));
  c.model.parameters = defaults.parameters;
  c.model.options = defaults.options;
  c.model.epsilon = "1e-5 + tanh(1 - 11*(x - 1)) + tanh(1 + 11*(x - 1))";
  c.model.initial = data;
  c.space.cells = {40};
  c.space.domain = {{0.0, 2.0}};
  c.space.discretization = how;
  c.space.reconstruction = "weno5-z";
  c.space.limiter = apsis::limiter_choice::positivity;
  c.velocity = {15.0, 150, apsis::equilibrium_choice::automatic};
  c.time.method = method;
  c.time.end = 0.5;
  c.time.cfl = 1.0 / 24.0;
  return c;
}

/// Returns a case with a coarse velocity grid, so that steps are cheap.
inline apsis::case_config small(const std::string& method, const std::string& how) {
  apsis::case_config c = mixed("mixed-v", method, how);
  c.space.cells = {20};
  c.velocity = {9.0, 36, apsis::equilibrium_choice::automatic};
  c.time.end = 0.05;
  return c;
}

/// Returns the number of cells in each direction that suffices. Thin parts of an STL surface need 8, a wing
/// section 16.
inline int enough_cells(const apsis::case_config& c, int usual) {
  for (const auto& body : c.bodies) {
    if (body.shape.shape == "stl") usual = std::max(usual, 8);
    if (body.shape.shape == "formula") usual = std::max(usual, 16);
  }
  return usual;
}

inline void finish(apsis::simulation& run) {
  while (!run.finished()) run.advance();
}

inline apsis::run_summary finished(const apsis::case_config& c) {
  apsis::simulation run(c);
  finish(run);
  return run.summary();
}
