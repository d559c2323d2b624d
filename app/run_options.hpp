#pragma once

#include <optional>
#include <string>
#include <vector>

namespace apsis::app {

/// The command line of `apsis run`.
struct run_options {
  std::string case_name;
  std::vector<std::string> overrides;
  std::optional<std::string> out, restart;
  std::optional<double> wall;  ///< seconds
  int threads = 1;
  bool json = false, profile = false;
};

}  // namespace apsis::app
