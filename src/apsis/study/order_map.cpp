#include <apsis/study/order_map.hpp>

#include <apsis/method/method.hpp>
#include <apsis/study/model_cases.hpp>
#include <apsis/study/time_study.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr double tolerance = 1e-11;           // of the references
constexpr double measurable = 5 * tolerance;  // smallest error that the references resolve

}  // namespace

double order_map::slope(std::size_t e, std::size_t k) const {
  const double coarse = error[e][k], fine = error[e][k + 1];
  return fine > measurable ? std::log2(coarse / fine) : std::numeric_limits<double>::quiet_NaN();
}

order_class order_map::kind(std::size_t e, std::size_t k) const {
  const double s = slope(e, k);
  if (std::isnan(s)) return order_class::unknown;
  if (s >= order - tolerated_loss) return order_class::design;
  return s < tolerated_loss ? order_class::plateau : order_class::reduced;
}

double order_map::smallest_slope() const {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < epsilon.size(); ++e)
    for (std::size_t k = 0; k + 1 < dt.size(); ++k)
      if (const double s = slope(e, k); s < smallest) smallest = s;
  return smallest;
}

double order_map::coarse_slope(std::size_t e, double smallest) const {
  std::size_t last = 0;
  while (last + 1 < dt.size() && error[e][last + 1] > std::max(smallest, measurable)) ++last;
  if (last == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::log2(error[e][0] / error[e][last]) / static_cast<double>(last);
}

double order_map::fine_slope(std::size_t e) const {
  std::size_t last = dt.size() - 1;
  while (last > 2 && !(error[e][last] > measurable)) --last;
  return std::log2(error[e][last - 2] / error[e][last]) / 2;
}

panel order_map::map() const {
  heat_map m{{}, epsilon, {}, "observed order", 0.0, static_cast<double>(order)};
  for (std::size_t k = 0; k + 1 < dt.size(); ++k) m.x.push_back(dt[k]);
  for (std::size_t e = 0; e < epsilon.size(); ++e) {
    m.value.emplace_back();
    for (std::size_t k = 0; k + 1 < dt.size(); ++k) m.value.back().push_back(slope(e, k));
  }
  return {method, "Δt (dimensionless)", "ε (dimensionless)", true, true, {}, {std::move(m)}, {}};
}

std::vector<order_map> measure_order_maps(const case_config& config, const std::vector<std::string>& methods,
                                          const std::vector<double>& epsilons, int coarsest, int finest,
                                          const study_control& control) {
  std::vector<order_map> maps;
  for (const auto& name : methods) {
    order_map m{config.model.name, name, find_method(name).claims.order, epsilons, {}, {}};
    for (int k = coarsest; k <= finest; ++k) m.dt.push_back(std::ldexp(config.time.end, -k));
    m.error.assign(epsilons.size(), std::vector<double>(m.dt.size()));
    maps.push_back(std::move(m));
  }
  run_all(control, "orders over eps and dt, " + config.model.name, static_cast<int>(epsilons.size()),
          [&](int job) {
            const auto e = static_cast<std::size_t>(job);
            const time_study study(config, epsilons[e]);
            const field exact = study.reference(start_data::given, tolerance, control);
            for (auto& m : maps)
              for (std::size_t k = 0; k < m.dt.size(); ++k)
                m.error[e][k] = largest_difference(
                    study.solve(find_method(m.method), 1L << (coarsest + static_cast<int>(k)),
                                start_data::given, first_step::plain, control),
                    exact);
          });
  return maps;
}

}  // namespace apsis
