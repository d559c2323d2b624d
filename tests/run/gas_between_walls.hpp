#pragma once

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

/// A small gas between two walls of different temperature, its result, and refused cases.
namespace between_walls {

/// `space` and `time` are lines of [space] and [time]; `more` has further tables.
struct gas {
  std::string method, time, more = "", space = "", epsilon = "0.05";
};

inline apsis::case_config case_of(const gas& given) {
  return apsis::parse_case(
      fmt::format(
          "[model]\nname = \"bgk\"\nepsilon = \"{}\"\n[initial]\nrho = \"1 + 0.1*cos(2*pi*x)\"\nu = 0\n"
          "T = 1\n[space]\ncells = 12\ndomain = [0, 1]\nboundary = \"diffuse\"\n{}\n[boundary.left]\n"
          "kind = \"diffuse\"\nT = 1.2\n[velocity]\nmax = 7\npoints = 24\n[time]\nmethod = \"{}\"\n{}\n{}",
          given.epsilon, given.space, given.method, given.time, given.more),
      "gas.toml");
}

inline std::vector<double> end_of(const apsis::case_config& c) {
  apsis::simulation run(c);
  while (!run.finished()) run.advance();
  return run.state();
}

/// Returns the 2-norm of a − b.
inline double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

}  // namespace between_walls
