#pragma once

#include <apsis/design/search.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace apsis::app {

/// Command line of `apsis design`.
struct design_options {
  std::optional<int> order, stages;
  int evaluations = 0, starts = 1000, steps = 1;
  std::optional<int> threads;
  bool implicit = false, json = false;
  std::string objective = "r", regime = "none", from, out, embedded, cost = "one-solve";
  double seconds = 60.0, sparsify = 0.0, band_weight = default_band_weight;
  std::uint64_t seed = 1;
  design_demands demands;
};

/// Returns the task of a command line. Throws input_error for values out of their ranges and for options that
/// exclude each other.
design_task task_of(const design_options& given);

}  // namespace apsis::app
