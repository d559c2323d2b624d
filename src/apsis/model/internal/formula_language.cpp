#include <apsis/model/internal/formula_language.hpp>

namespace apsis {

const std::vector<std::string>& formula_language::names() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const auto& one : constants) names.emplace_back(one.name);
    for (const auto& one : functions_of_one) names.emplace_back(one.name);
    for (const auto& one : functions_of_two) names.emplace_back(one.name);
    for (const char* table : {"table", "table2"}) names.emplace_back(table);
    return names;
  }();
  return all;
}

}  // namespace apsis
