#include "method_table.hpp"

#include <apsis/method/method.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace apsis::app {
namespace {

using json = nlohmann::ordered_json;

/// "any", "cons.", "any m", … of "any data", "consistent data", "any data (moments only)", …
std::string short_data(const std::string& data) {
  if (data.empty() || data == "none") return "-";
  const std::string first = data.starts_with("any") ? "any" : "cons.";
  return data.ends_with("(moments only)") ? first + " m" : first;
}

/// A number of the table, "-" if there is none.
std::string entry(const json& number, const std::string& none = "-") {
  return number.is_null() ? none : fmt::format("{:.4g}", number.get<double>());
}

}  // namespace

std::string method_table(const json& all) {
  const auto row = [](const auto&... cells) {
    std::string line =
        fmt::format("{:<23}{:>3}{:>4}{:>5}{:>8}{:>10}{:>7}{:>9}{:>8}{:>4}  {:<9}{:<6}{}", cells...);
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
  };
  std::string out;
  for (const auto kind : all_method_kinds) {
    out += fmt::format("{}{} methods\n", out.empty() ? "" : "\n", to_string(kind));
    out += row("name", "p", "s", "n_F", "solves", "r", "r/n_F", "error", "buffers", "emb", "AP", "eps",
               "recommended for");
    for (const auto& c : all) {
      if (c["kind"] != to_string(kind)) continue;
      const bool has_terms = c.contains("intermediate_regime") && !c["intermediate_regime"].is_null();
      out += row(c["name"].get<std::string>(), c["order"].get<int>(), c["stages"].get<int>(),
                 c["explicit_evaluations"].get<int>(), c["implicit_solves"].get<int>(),
                 entry(c["ssp_coefficient"], "unbounded"), entry(c["r_per_evaluation"]),
                 entry(c["error_constant"]), c["buffers"].get<int>(),
                 c["embedded"].is_null() ? "-" : std::to_string(c["embedded"]["order"].get<int>()),
                 short_data(c["ap_data"].get<std::string>()),
                 has_terms ? c["intermediate_regime"]["keeps"].get<std::string>() : std::string("-"),
                 c["purpose"].get<std::string>());
    }
  }
  return out + R"(
p order, s stages, n_F transport evaluations, solves of Q, r SSP coefficient, error: 2-norm of the residuals of
order p + 1, buffers of the size of a state, emb: order of the embedded solution, from which the error of a step is
estimated (time.tolerance), AP: the initial data for which the limit epsilon -> 0 is right (cons.:
consistent data only, m: in the moments only), eps: which terms of size epsilon are right for epsilon << dt
(slow: for data near equilibrium).
)";
}

}  // namespace apsis::app
