#pragma once

#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace apsis {

/// Returns suggest(word, variables). The name of a quantity, such as "temperature", leads to its symbol.
inline std::string suggest_variable(const std::string& word, const std::vector<std::string>& variables) {
  static const std::map<std::string, std::string> symbols = {
      {"density", "rho"}, {"pressure", "p"}, {"temperature", "T"}, {"u", "velocity"}, {"velocity", "u"}};
  const auto found = symbols.find(word);
  const bool known = found != symbols.end() &&
                     std::find(variables.begin(), variables.end(), found->second) != variables.end();
  return suggest(known ? found->second : word, variables);
}

}  // namespace apsis
