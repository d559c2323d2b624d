#pragma once

#include <optional>
#include <string>

namespace apsis::app {

/// The command line of `apsis design --embedded METHOD`.
struct embedded_options {
  std::string method;              ///< a method of the catalogue or of a family, or FILE.toml
  std::optional<int> order;        ///< order of the embedded solution; the highest useful one if not given
  std::string cost = "one-solve";  ///< or "nothing"
  std::string out;
  bool json = false;
};

/// Finds an embedded solution, writes the method with it to a file and reports the certificate. Returns 0.
/// Throws input_error, io_error, numerical_error with the nearest residuals if there is no such solution, and
/// claim_error if a claim does not hold.
int design_embedded(const embedded_options& given);

}  // namespace apsis::app
