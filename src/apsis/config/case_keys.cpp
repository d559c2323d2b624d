#include <apsis/config/internal/key_table.hpp>

#include <algorithm>
#include <utility>

namespace apsis {

const std::vector<case_key>& case_schema() {
  static const std::vector<case_key> schema = [] {
    auto tables = key_table_entries();
    std::sort(tables.begin(), tables.end(), [](const auto* a, const auto* b) { return a->place < b->place; });
    std::vector<case_key> all;
    for (const auto* table : tables)
      for (case_key& one : table->keys()) all.push_back(std::move(one));
    return all;
  }();
  return schema;
}

case_key if_given(case_key of) {
  of.load = [load = std::move(of.load)](const case_config& c) -> case_value {
    case_value value = load(c);
    if (value == case_value(0.0) || value == case_value(std::vector<long>{0}) ||
        value == case_value(std::vector<std::string>{}) ||
        value == case_value(std::vector<std::vector<double>>{}))
      return {};
    return value;
  };
  return of;
}

case_key only_if(bool (*property)(const case_config&), case_key of) {
  of.load = [property, load = std::move(of.load)](const case_config& c) -> case_value {
    return property(c) ? load(c) : case_value{};
  };
  return of;
}

}  // namespace apsis
