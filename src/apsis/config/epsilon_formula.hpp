#pragma once

#include <apsis/model/expression.hpp>

#include <string>
#include <utility>

namespace apsis {

/// The relaxation time ε of a case, dimensionless, ≥ 0: a number or a formula in x, y, z, or a formula for a
/// Knudsen number or a rarefaction parameter with its conversion.
struct epsilon_formula {
  std::string text = "1";             ///< number or formula, as given
  std::string key = "model.epsilon";  ///< path of the key that gives the text
  std::string mean_free_path = {};    ///< definition of λ, for "model.knudsen.value"
  value_conversion conversion = {};   ///< of the value of the text to ε

  /// Sets ε itself.
  epsilon_formula& operator=(std::string epsilon) {
    *this = epsilon_formula();
    text = std::move(epsilon);
    return *this;
  }
};

}  // namespace apsis
