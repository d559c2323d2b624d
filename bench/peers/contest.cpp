#include "contest.hpp"
#include "integrators.hpp"
#include "measure/clock.hpp"

#include <apsis/method/certificate.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace apsis::bench::peers {
namespace {

constexpr double any = -std::numeric_limits<double>::infinity();

/// Whether a run counts. Runs of methods with an SSP coefficient must not have negative unknowns.
bool is_valid(const attempt& one) {
  return one.measured.failure.empty() && (one.of != league::ssp || one.measured.smallest >= 0.0);
}

const char* name_of(league one) {
  switch (one) {
    case league::ssp:
      return "ssp";
    case league::any_sign:
      return "any sign";
    case league::adaptive:
      return "adaptive";
    case league::baseline:
      return "baseline";
    case league::other:
      break;
  }
  return "other";
}

}  // namespace

std::vector<std::string> imex_contestants() {
  std::vector<std::string> names;
  for (const auto& name : method_names())
    if (find_method(name).kind == method_kind::imex) names.push_back(name);
  for (int order = 2; order <= 8; ++order) names.push_back(fmt::format("extrapolated-euler-{}", order));
  return names;
}

std::vector<std::string> explicit_contestants() {
  std::vector<std::string> names;
  for (const auto& name : method_names())
    if (find_method(name).kind == method_kind::explicit_only) names.push_back(name);
  return names;
}

league league_of(const std::string& method) {
  const time_integrator& m = find_integrator(method);
  if (m.one_step() == nullptr) return m.ssp_coefficient > 0 ? league::ssp : league::baseline;
  const certificate& c = find_certificate(method);
  if (m.needs.exact_collision) return league::baseline;
  if (!(c.ssp_coefficient > 0)) return league::any_sign;
  return c.kind == method_kind::explicit_only ? league::other : league::ssp;
}

std::vector<double> two_per_decade(double loosest, double tightest) {
  std::vector<double> all;
  for (double tolerance = loosest; tolerance > 0.99 * tightest; tolerance *= 0.316227766)
    all.push_back(tolerance);
  return all;
}

/// Returns lower bounds of the unknowns: nonnegative, nonnegative up to the rounding errors of a projection,
/// any sign.
std::vector<double> contest::floors() const {
  return signs_ ? std::vector<double>{0.0, -1e-20, any} : std::vector<double>{any};
}

void contest::run(int repeats, double seconds_each) {
  for (auto& one : attempts_) {
    one.measured = one.run();
    if (one.measured.seconds < 0.02) continue;  // too short to matter
    fmt::print(stderr, "  {}, {}: {:.3g} s, error {:.3g}, smallest {:.2g}, {} steps {}\n", one.contestant,
               one.setting, one.measured.seconds, one.measured.error, one.measured.smallest,
               one.measured.steps, one.measured.failure);
  }
  choose();
  std::map<std::size_t, std::vector<double>> seconds;
  for (std::size_t k = 0; k < attempts_.size(); ++k)
    if (attempts_[k].counts && attempts_[k].measured.seconds < seconds_each) seconds[k] = {};
  for (int turn = 0; turn < repeats; ++turn)
    for (auto& [index, times] : seconds) times.push_back(attempts_[index].run().seconds);
  for (auto& [index, times] : seconds)
    if (!times.empty()) attempts_[index].measured.seconds = median(times);
}

std::size_t contest::cheapest(double error, const filter& allowed) const {
  std::size_t best = none;
  for (std::size_t k = 0; k < attempts_.size(); ++k) {
    const auto& one = attempts_[k];
    if (!is_valid(one) || !(one.measured.error <= error) || !allowed(one)) continue;
    if (best == none || one.measured.seconds < attempts_[best].measured.seconds) best = k;
  }
  return best;
}

void contest::choose() {
  for (const auto& one : attempts_)
    if (std::find(names_.begin(), names_.end(), one.contestant) == names_.end())
      names_.push_back(one.contestant);
  const auto take = [this](std::size_t index) {
    if (index != none) attempts_[index].counts = true;
    return index;
  };
  for (const auto& name : names_) {
    chosen_.emplace_back();
    for (const double error : errors_)
      chosen_.back().push_back(
          take(cheapest(error, [&](const attempt& one) { return one.contestant == name; })));
  }
  for (const double floor : floors())
    for (const double error : errors_)
      for (const league side : {league::ssp, league::baseline, league::other})
        take(cheapest(error, [&](const attempt& one) {
          return (one.ours() ? league::ssp : one.of) == side && one.measured.smallest >= floor;
        }));
}

double contest::best_seconds(std::size_t error, double floor) const {
  const auto best = cheapest(errors_[error], [&](const attempt& one) {
    return one.ours() && one.counts && one.measured.smallest >= floor;
  });
  return best == none ? std::numeric_limits<double>::quiet_NaN() : attempts_[best].measured.seconds;
}

std::string contest::time(std::size_t index) const {
  return fmt::format("{:.3g}", (unit_ == "s" ? 1.0 : 1e6) * attempts_[index].measured.seconds);
}

std::string contest::ratio(std::size_t index, std::size_t error, double floor) const {
  const double ratio = attempts_[index].measured.seconds / best_seconds(error, floor);
  if (std::isnan(ratio)) return "";
  return ratio < 100.0 ? fmt::format("({:.2g})", ratio) : fmt::format("({:.0f})", ratio);
}

void contest::add_to(result_table& result, std::optional<double> epsilon, bool only_others) const {
  result.columns = columns();
  if (epsilon) result.columns.insert(result.columns.begin(), "ε");
  for (const auto& some : {best_of_ours(), rows(only_others), best_of_others(), best_of_baselines()})
    for (auto row : some) {
      if (epsilon) row.insert(row.begin(), fmt::format("{:g}", *epsilon));
      result.rows.push_back(std::move(row));
    }
  for (auto point : points()) {
    if (epsilon) point["epsilon"] = *epsilon;
    result.data["points"].push_back(std::move(point));
  }
}

std::vector<std::vector<nlohmann::json>> contest::rows(bool only_others) const {
  const auto is_ours = [this](const std::string& name) {
    return std::any_of(attempts_.begin(), attempts_.end(),
                       [&](const attempt& one) { return one.contestant == name && one.ours(); });
  };
  std::vector<std::vector<nlohmann::json>> all;
  for (std::size_t n = 0; n < names_.size(); ++n) {
    if (only_others && is_ours(names_[n])) continue;
    std::vector<nlohmann::json> row = {names_[n]};
    for (std::size_t e = 0; e < errors_.size(); ++e) {
      const auto index = chosen_[n][e];
      const bool reached = index != none;
      row.push_back(reached ? nlohmann::json(time(index) + " " + ratio(index, e, floors().front()))
                            : nlohmann::json());
      if (!signs_) continue;
      row.push_back(reached ? nlohmann::json(fmt::format("{:.0e}", attempts_[index].measured.smallest))
                            : nlohmann::json());
    }
    all.push_back(std::move(row));
  }
  return all;
}

std::vector<std::vector<nlohmann::json>> contest::best_of_ours() const {
  const std::pair<const char*, filter> groups[] = {
      {"best of Apsis", [](const attempt& one) { return one.ours(); }},
      {"best with an SSP coefficient", [](const attempt& one) { return one.of == league::ssp; }},
      {"best with steps by tolerance", [](const attempt& one) { return one.of == league::adaptive; }}};
  std::vector<std::vector<nlohmann::json>> all;
  for (const auto& [label, allowed] : groups) {
    std::vector<nlohmann::json> row = {label};
    bool any_run = false;
    for (const double error : errors_) {
      const auto best = cheapest(error, [&](const attempt& one) { return one.counts && allowed(one); });
      any_run = any_run || best != none;
      row.push_back(best == none ? nlohmann::json()
                                 : nlohmann::json(time(best) + " " + attempts_[best].contestant));
      if (!signs_) continue;
      row.push_back(best == none ? nlohmann::json()
                                 : nlohmann::json(fmt::format("{:.0e}", attempts_[best].measured.smallest)));
    }
    if (any_run) all.push_back(std::move(row));
  }
  return all;
}

std::vector<std::vector<nlohmann::json>> contest::best_of_others() const {
  return best_of(league::other, "best of the others");
}

std::vector<std::vector<nlohmann::json>> contest::best_of_baselines() const {
  const bool any_entered = std::any_of(attempts_.begin(), attempts_.end(),
                                       [](const attempt& one) { return one.of == league::baseline; });
  return any_entered ? best_of(league::baseline, "best of the baselines")
                     : std::vector<std::vector<nlohmann::json>>();
}

std::vector<std::vector<nlohmann::json>> contest::best_of(league these, const std::string& label) const {
  std::vector<std::vector<nlohmann::json>> all;
  for (const double floor : floors()) {
    std::vector<nlohmann::json> row = {std::isinf(floor) ? label
                                                         : fmt::format("{} with least ≥ {:g}", label, floor)};
    for (std::size_t e = 0; e < errors_.size(); ++e) {
      const auto best = cheapest(errors_[e], [&](const attempt& one) {
        return one.of == these && one.counts && one.measured.smallest >= floor;
      });
      const bool found = best != none;
      const auto name = found ? attempts_[best].contestant : std::string();
      if (signs_) {
        row.push_back(found ? nlohmann::json(ratio(best, e, floor)) : nlohmann::json());
        row.push_back(found ? nlohmann::json(name) : nlohmann::json());
      } else {
        row.push_back(found ? nlohmann::json(name + " " + ratio(best, e, floor)) : nlohmann::json());
      }
    }
    all.push_back(std::move(row));
  }
  return all;
}

nlohmann::json contest::points() const {
  nlohmann::json all = nlohmann::json::array();
  for (const auto& one : attempts_) {
    nlohmann::json point = {{"contestant", one.contestant},
                            {"setting", one.setting},
                            {"ours", one.ours()},
                            {"league", name_of(one.of)},
                            {"error", one.measured.error},
                            {"seconds", one.measured.seconds},
                            {"smallest", one.measured.smallest},
                            {"smallest_final", one.measured.smallest_final},
                            {"steps", one.measured.steps}};
    if (!one.measured.failure.empty()) point["failure"] = one.measured.failure;
    all.push_back(std::move(point));
  }
  return all;
}

std::vector<std::string> contest::columns() const {
  std::vector<std::string> names = {"contestant"};
  for (const double error : errors_) {
    names.push_back(fmt::format("error {:g} ({})", error, unit_));
    if (signs_) names.emplace_back("least");
  }
  return names;
}

}  // namespace apsis::bench::peers
