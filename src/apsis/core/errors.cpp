#include <apsis/core/errors.hpp>

#include <cmath>

#include <fmt/format.h>

namespace apsis {

std::string to_string(const source_place& place) {
  std::string text = place.file;
  if (place.line > 0) text += fmt::format("{}{}", text.empty() ? "" : ":", place.line);
  if (place.line > 0 && place.column > 0) text += fmt::format(":{}", place.column);
  return text.empty() ? text : text + ": ";
}

namespace {
std::string describe(const std::string& problem, const failure_site& site) {
  std::string where;
  const auto add = [&where](const std::string& part) { where += (where.empty() ? "" : ", ") + part; };
  if (site.step >= 0) add(fmt::format("step {}", site.step));
  if (!std::isnan(site.t)) add(fmt::format("t = {:.10g}", site.t));
  if (site.cell >= 0) add(fmt::format("cell {}", site.cell));
  if (!std::isnan(site.value)) add(fmt::format("value {:.10g}", site.value));
  return where.empty() ? problem : problem + " [" + where + "]";
}
}  // namespace

numerical_error::numerical_error(const std::string& problem, failure_site site)
    : error(exit_code::numerical, describe(problem, site)), problem_(problem), site_(site) {}

numerical_error numerical_error::at(long step, double t) const {
  failure_site full = site_;
  full.step = step;
  full.t = t;
  return numerical_error(problem_, full);
}

}  // namespace apsis
