#pragma once

#include <apsis/model/expression.hpp>

#include <string>
#include <utility>

namespace apsis {

/// The relaxation time ε ≥ 0 of a case, dimensionless. It is given by a number or formula in x, y, z for ε,
/// for a Knudsen number, or for a rarefaction parameter. The last two have a conversion.
struct epsilon_formula {
  std::string text = "1";             ///< number or formula, as given
  std::string key = "model.epsilon";  ///< path of the key that gives the text
  std::string mean_free_path = {};    ///< definition of λ, for "model.knudsen.value"
  value_conversion conversion = {};   ///< conversion of the value of the text to ε

  /// Sets ε itself.
  epsilon_formula& operator=(std::string epsilon) {
    *this = epsilon_formula();
    text = std::move(epsilon);
    return *this;
  }
};

}  // namespace apsis
