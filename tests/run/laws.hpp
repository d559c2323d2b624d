#pragma once

#include "cases.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>

/// Overrides key=value of a case.
using overrides = std::vector<std::string>;

/// A case by its text, run to its end.
inline apsis::simulation finished_run(const std::string& text, const overrides& changes) {
  apsis::simulation run(apsis::parse_case(text, "law", changes));
  finish(run);
  return run;
}

/// The built-in case laws/NAME, run to its end.
inline apsis::simulation finished_case(const std::string& name, const overrides& changes) {
  return finished_run(apsis::read_case("laws/" + name), changes);
}

/// The override of the number of cells.
inline std::string cells(int n) {
  return fmt::format("space.cells={}", n);
}
