#include <paper/reproduce.hpp>

#include <apsis/core/errors.hpp>

#include <chrono>
#include <cmath>

#include <nlohmann/json.hpp>

namespace apsis::paper {
namespace {

using json = nlohmann::ordered_json;

json to_json(const finding& f) {
  return {{"what", f.what},
          {"value", std::isfinite(f.value) ? json(f.value) : json(nullptr)},
          {"condition", f.condition},
          {"holds", f.holds}};
}

json to_json(const report_table& t) {
  return {{"title", t.title}, {"columns", t.columns}, {"rows", t.rows}};
}

template <class Item>
json list(const std::vector<Item>& items) {
  json out = json::array();
  for (const auto& item : items) out.push_back(to_json(item));
  return out;
}

}  // namespace

json check_claim(const claim_entry& claim, const study_control& control) {
  const auto start = std::chrono::steady_clock::now();
  claim_result result;
  std::string problem;
  try {
    result = claim.check(control);
  } catch (const error& failure) {
    problem = failure.what();
  }
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {{"id", claim.id},
          {"section", claim.section},
          {"statement", claim.statement},
          {"how", claim.how},
          {"holds", problem.empty() && result.all_hold()},
          {"error", problem},
          {"findings", list(result.findings)},
          {"tables", list(result.tables)},
          {"pictures", list(result.pictures)},
          {"remarks", result.remarks},
          {"wall_s", wall}};
}

}  // namespace apsis::paper
