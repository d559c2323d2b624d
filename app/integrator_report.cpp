#include "integrator_report.hpp"
#include "method_report.hpp"

#include <apsis/integrate/schedule.hpp>
#include <apsis/run/cfl_limit.hpp>

#include <algorithm>
#include <type_traits>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis::app {
namespace {

using json = nlohmann::ordered_json;

/// Returns the JSON pointer "/a/b" of the key "a.b".
json::json_pointer place_of(std::string key) {
  std::replace(key.begin(), key.end(), '.', '/');
  return json::json_pointer("/" + key);
}

json value_of(const time_integrator& m, const integrator_certificate::fact& one) {
  const auto given = [](const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>)
      return json();
    else
      return json(value);
  };
  if (!std::holds_alternative<std::monostate>(one.is)) return std::visit(given, one.is);
  return one.key == "cfl_limits" ? cfl_json(cfl_limits(m.growth())) : json(buffers_of(m));
}

}  // namespace

json integrator_json(const time_integrator& m) {
  if (m.one_step() != nullptr) return check_json(*m.one_step());
  const auto c = m.certify();
  json out = {{"name", m.name}, {"title", m.title}};
  for (const auto& one : c.facts) out[place_of(one.key)] = value_of(m, one);
  out["claims_hold"] = c.claims_hold();
  out["failures"] = c.failures;
  return out;
}

std::string integrator_text(const time_integrator& m) {
  if (m.one_step() != nullptr) return check_text(*m.one_step());
  const auto c = m.certify();
  std::string out = fmt::format("{}: {}\n", m.name, m.title);
  for (const auto& [label, text] : c.lines)
    out +=
        fmt::format("  {:<22} {}\n", label, text ? *text : "CFL number " + cfl_text(cfl_limits(m.growth())));
  if (c.claims_hold()) return out + "  all claims hold\n";
  return out + fmt::format("  FAILED: {}\n", fmt::join(c.failures, "; "));
}

}  // namespace apsis::app
