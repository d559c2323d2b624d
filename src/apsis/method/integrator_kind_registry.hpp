#pragma once

#include <apsis/method/time_integrator.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// A kind of time integrator. method/kinds/NAME.cpp defines `extern const integrator_kind_entry
/// integrator_kind_NAME`, and integrate/kinds/NAME.hpp implements its steps. A line of
/// integrate/any_stepper.hpp joins the two. Members are method files, formulas, or both.
struct integrator_kind_entry {
  std::string name,  ///< time_integrator::kind
      description;   ///< one line: how u^{n+1} is computed
  /// Returns whether a parsed method file is a member; nullptr if no file is.
  bool (*reads)(const method& file) = nullptr;
  /// Makes the member of a method file, without checking its claims. Required with `reads`.
  std::unique_ptr<time_integrator> (*of_file)(method file) = nullptr;
  /// Returns the names of the formulas; nullptr if there are no formulas.
  std::vector<std::string> (*formulas)() = nullptr;
  /// Makes the formula of one of these names. Required with `formulas`.
  std::unique_ptr<time_integrator> (*of_formula)(const std::string& name) = nullptr;
};

/// Returns all kinds, in the order of the registry.
std::vector<const integrator_kind_entry*> integrator_kind_entries();

/// Makes the integrator of a parsed method file without checking its claims. Throws input_error if the file
/// is of no kind.
std::unique_ptr<time_integrator> integrator_of_file(method file);

}  // namespace apsis
