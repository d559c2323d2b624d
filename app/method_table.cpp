#include "method_table.hpp"
#include "text_table.hpp"

#include <apsis/method/method.hpp>

#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

using json = nlohmann::ordered_json;

/// Returns "any", "cons.", "any m", … for "any data", "consistent data", "any data (moments only)", …
std::string short_data(const std::string& data) {
  if (data.empty() || data == "none") return "-";
  const std::string first = data.starts_with("any") ? "any" : "cons.";
  return data.ends_with("(moments only)") ? first + " m" : first;
}

/// Returns a number as text; `none` for null.
std::string entry(const json& number, const std::string& none = "-") {
  return number.is_null() ? none : fmt::format("{:.4g}", number.get<double>());
}

std::vector<std::string> row_of(const json& c) {
  const bool has_terms = c.contains("intermediate_regime") && !c["intermediate_regime"].is_null();
  const auto whole = [&c](const char* name) { return std::to_string(c[name].get<int>()); };
  return {c["name"].get<std::string>(),
          whole("order"),
          whole("stages"),
          whole("explicit_evaluations"),
          whole("implicit_solves"),
          entry(c["ssp_coefficient"], "unbounded"),
          entry(c["r_per_evaluation"]),
          entry(c["error_constant"]),
          whole("buffers"),
          c["embedded"].is_null() ? "-" : std::to_string(c["embedded"]["order"].get<int>()),
          short_data(c["ap_data"].get<std::string>()),
          has_terms ? c["intermediate_regime"]["keeps"].get<std::string>() : std::string("-"),
          c["purpose"].get<std::string>()};
}

}  // namespace

std::string method_table(const json& all) {
  const std::vector<std::string> head = {"name",           "p",     "s",       "n_F", "solves", "r",
                                         "r/n_F",          "error", "buffers", "emb", "AP",     "eps",
                                         "recommended for"};
  text_table table({true, false, false, false, false, false, false, false, false, false, true, true, true});
  for (const auto kind : all_method_kinds) {
    if (kind != all_method_kinds.front()) table.add_line("");
    table.add_line(fmt::format("{} methods", to_string(kind)));
    table.add(head);
    for (const auto& c : all)
      if (c["kind"] == to_string(kind)) table.add(row_of(c));
  }
  const std::string out = table.text();
  return out + R"(
p order, s stages, n_F transport evaluations, solves of Q, r SSP coefficient, error: 2-norm of the residuals of
order p + 1, buffers of the size of a state, emb: order of the embedded solution, from which the error of a step is
estimated (time.tolerance), AP: the initial data for which the limit epsilon -> 0 is right (cons.:
consistent data only, m: in the moments only), eps: which terms of size epsilon are right for epsilon << dt
(slow: for data near equilibrium).
)";
}

}  // namespace apsis::app
