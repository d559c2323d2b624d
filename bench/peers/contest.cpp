#include "contest.hpp"
#include "measure/clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

namespace apsis::bench::peers {
namespace {

/// Lower bounds of f: nonnegative, nonnegative up to the rounding errors of a projection, any sign.
constexpr double floors[] = {0.0, -1e-20, -std::numeric_limits<double>::infinity()};

}  // namespace

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

bool contest::reaches(const attempt& one, double error) const {
  if (!one.measured.failure.empty() || !(one.measured.error <= error)) return false;
  return !one.ours || rule_ == rule::any_sign || one.measured.smallest >= 0.0;
}

std::size_t contest::cheapest(double error, const std::function<bool(const attempt&)>& allowed) const {
  std::size_t best = none;
  for (std::size_t k = 0; k < attempts_.size(); ++k) {
    const auto& one = attempts_[k];
    if (!allowed(one) || !reaches(one, error)) continue;
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
  for (const double floor : floors)
    for (const double error : errors_)
      take(cheapest(error, [&](const attempt& one) { return !one.ours && one.measured.smallest >= floor; }));
}

double contest::best_seconds(std::size_t error) const {
  const auto best = cheapest(errors_[error], [](const attempt& one) { return one.ours && one.counts; });
  return best == none ? std::numeric_limits<double>::quiet_NaN() : attempts_[best].measured.seconds;
}

/// Formats seconds, or microseconds for short times.
std::string contest::time(std::size_t index) const {
  const double seconds = attempts_[index].measured.seconds;
  return rule_ == rule::any_sign ? fmt::format("{:.3g}", 1e6 * seconds) : fmt::format("{:.3g}", seconds);
}

std::string contest::ratio(std::size_t index, std::size_t error) const {
  const double ratio = attempts_[index].measured.seconds / best_seconds(error);
  if (std::isnan(ratio)) return "";
  return ratio < 100.0 ? fmt::format("({:.2g})", ratio) : fmt::format("({:.0f})", ratio);
}

std::vector<std::vector<nlohmann::json>> contest::rows() const {
  std::vector<std::vector<nlohmann::json>> all;
  for (std::size_t n = 0; n < names_.size(); ++n) {
    std::vector<nlohmann::json> row = {names_[n]};
    for (std::size_t e = 0; e < errors_.size(); ++e) {
      const auto index = chosen_[n][e];
      const bool reached = index != none;
      row.push_back(reached ? nlohmann::json(time(index) + " " + ratio(index, e)) : nlohmann::json());
      if (rule_ == rule::any_sign) continue;
      row.push_back(reached ? nlohmann::json(fmt::format("{:.0e}", attempts_[index].measured.smallest))
                            : nlohmann::json());
    }
    all.push_back(std::move(row));
  }
  return all;
}

std::vector<std::vector<nlohmann::json>> contest::best_of_others() const {
  std::vector<std::vector<nlohmann::json>> all;
  for (const double floor : floors) {
    if (rule_ == rule::any_sign && !std::isinf(floor)) continue;
    std::vector<nlohmann::json> row = {std::isinf(floor)
                                           ? std::string("best of the others")
                                           : fmt::format("best of the others with least ≥ {:g}", floor)};
    for (std::size_t e = 0; e < errors_.size(); ++e) {
      const auto best = cheapest(errors_[e], [&](const attempt& one) {
        return !one.ours && one.counts && one.measured.smallest >= floor;
      });
      const bool found = best != none;
      const auto name = found ? attempts_[best].contestant : std::string();
      if (rule_ == rule::any_sign) {
        row.push_back(found ? nlohmann::json(name + " " + ratio(best, e)) : nlohmann::json());
      } else {
        row.push_back(found ? nlohmann::json(ratio(best, e)) : nlohmann::json());
        row.push_back(found ? nlohmann::json(name) : nlohmann::json());
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
                            {"ours", one.ours},
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
    names.push_back(fmt::format("error {:g} ({})", error, rule_ == rule::any_sign ? "µs" : "s"));
    if (rule_ == rule::nonnegative) names.emplace_back("least");
  }
  return names;
}

}  // namespace apsis::bench::peers
