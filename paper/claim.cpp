#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <paper/claim_registry.hpp>

namespace apsis::paper {

finding at_most(std::string what, double value, double bound) {
  return {std::move(what), value, fmt::format("at most {:.4g}", bound), value <= bound};
}
finding at_least(std::string what, double value, double bound) {
  return {std::move(what), value, fmt::format("at least {:.4g}", bound), value >= bound};
}
finding close_to(std::string what, double value, double target, double tolerance) {
  return {std::move(what), value, fmt::format("{:.15g} ± {:.2g}", target, tolerance),
          std::abs(value - target) <= tolerance};
}
finding exactly(std::string what, long value, long wanted) {
  return {std::move(what), static_cast<double>(value), fmt::format("{}", wanted), value == wanted};
}
finding is_true(std::string what, bool value) {
  return {std::move(what), value ? 1.0 : 0.0, "true", value};
}

bool claim_result::all_hold() const {
  return !findings.empty() &&
         std::all_of(findings.begin(), findings.end(), [](const finding& f) { return f.holds; });
}

std::vector<const claim_entry*> find_claims(const std::vector<std::string>& ids) {
  auto all = claim_entries();
  if (ids.empty()) return all;
  std::vector<std::string> names;
  for (const claim_entry* entry : all) names.push_back(entry->id);
  std::vector<bool> wanted(all.size(), false);
  for (std::string id : ids) {
    std::transform(id.begin(), id.end(), id.begin(), [](unsigned char c) { return std::toupper(c); });
    const auto found = std::find(names.begin(), names.end(), id);
    if (found == names.end())
      throw input_error(fmt::format("no claim '{}' (the paper's claims are numbered); {}", id.substr(0, 20),
                                    suggest(id, names)));
    wanted[static_cast<std::size_t>(found - names.begin())] = true;
  }
  std::vector<const claim_entry*> chosen;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (wanted[k]) chosen.push_back(all[k]);
  return chosen;
}

}  // namespace apsis::paper
