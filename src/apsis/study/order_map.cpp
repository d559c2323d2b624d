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

constexpr double tolerance = 1e-11;           // of the references …
constexpr double measurable = 5 * tolerance;  // … which are about as good
constexpr double tolerated_loss = 0.3;

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

void add_order_maps(const std::string& id, const study_control& control, claim_result& result) {
  const std::string papers[] = {"md-imex-3-2", "md-imex-6-3"};
  const std::vector<std::string> methods = {papers[0], papers[1], "md-imex-5-2", "md-imex-8-3"};
  std::vector<double> epsilons;
  for (int k = 0; k <= 8; ++k) epsilons.push_back(std::pow(10.0, -k));
  report_table table{"how many of the steps halved show which order",
                     {"model", "method", "design order", "reduced", "plateau", "not measurable"},
                     {}};
  for (const auto& model : relaxation_model_names()) {
    // First-order upwinding is linear; weights of WENO that switch where data are flat cost order in time.
    std::vector<std::string> overrides = {"time.end=1"};
    if (model != "ode") overrides = {"space.reconstruction=upwind1"};
    if (model == "bgk") overrides.emplace_back("velocity.points=36");  // enough for a test of time steps
    const auto maps = measure_order_maps(small_case(model, overrides), methods, epsilons, 3, 10, control);
    picture p{fmt::format("{}-order-{}", id, model),
              "Observed order, " + model,
              "Observed order between Δt and Δt/2 from data out of equilibrium. Top: ε ≫ Δt; bottom: the "
              "limit. Between, the paper's methods have plateaus proportional to ε. For md-imex-5-2 and "
              "md-imex-8-3 low orders mark the rise of errors ε²/Δt towards Δt = ε; beyond, for ε ≪ Δt, the "
              "order holds. Empty: less than the reference can tell.",
              {}};
    for (const auto& m : maps) {
      p.panels.push_back(m.map());
      int count[4] = {};
      for (std::size_t e = 0; e < m.epsilon.size(); ++e)
        for (std::size_t k = 0; k + 1 < m.dt.size(); ++k) ++count[static_cast<int>(m.kind(e, k))];
      table.rows.push_back({model, m.method, std::to_string(count[0]), std::to_string(count[1]),
                            std::to_string(count[2]), std::to_string(count[3])});
      if (m.method != papers[0] && m.method != papers[1]) continue;
      const std::string name = model + ", " + m.method;
      result.findings.push_back(
          near(name + ": order at eps = 1, smallest steps", m.fine_slope(0), m.order, 0.15));
      // Down to where the plateau, up to ε itself, takes over.
      const std::size_t last = m.epsilon.size() - 1;
      result.findings.push_back(near(name + ": order at eps = 1e-8 above the plateau",
                                     m.coarse_slope(last, 3 * m.epsilon[last]), m.order, 0.25));
      result.findings.push_back(
          at_most(name + ": smallest order between", m.smallest_slope(), tolerated_loss));
    }
    result.pictures.push_back(std::move(p));
  }
  result.tables.push_back(std::move(table));
}

}  // namespace apsis
