#pragma once

#include "cases.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

/// Overrides key=value of a case.
using overrides = std::vector<std::string>;

/// Runs a case, given by its text, to its end.
inline apsis::simulation finished_run(const std::string& text, const overrides& changes) {
  apsis::simulation run(apsis::parse_case(text, "law", changes));
  finish(run);
  return run;
}

/// Runs the built-in case laws/NAME to its end.
inline apsis::simulation finished_case(const std::string& name, const overrides& changes) {
  return finished_run(apsis::read_case("laws/" + name), changes);
}

/// Returns the override of the number of cells.
inline std::string cells(int n) {
  return fmt::format("space.cells={}", n);
}
