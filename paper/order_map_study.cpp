#include <paper/order_map_study.hpp>

#include <apsis/study/model_cases.hpp>
#include <apsis/study/order_map.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis::paper {

void add_order_maps(const std::string& id, const study_control& control, claim_result& result) {
  const std::string papers[] = {"md-imex-3-2", "md-imex-6-3"};
  const std::vector<std::string> methods = {papers[0], papers[1], "md-imex-5-2", "md-imex-8-3"};
  std::vector<double> epsilons;
  for (int k = 0; k <= 8; ++k) epsilons.push_back(std::pow(10.0, -k));
  report_table table{"how many of the steps halved show which order",
                     {"model", "method", "design order", "reduced", "plateau", "not measurable"},
                     {}};
  for (const auto& model : relaxation_model_names()) {
    // First-order upwinding is linear. WENO weights would switch where data are flat, and reduce the order
    // in time.
    std::vector<std::string> overrides = {"time.end=1"};
    if (model != "ode") overrides = {"space.reconstruction=upwind1"};
    if (model == "bgk") overrides.emplace_back("velocity.points=36");  // sufficient for a test of time steps
    const auto maps = measure_order_maps(small_case(model, overrides), methods, epsilons, 3, 10, control);
    picture p{fmt::format("{}-order-{}", id, model),
              "Observed order, " + model,
              "Observed order between Δt and Δt/2 from data out of equilibrium. Top: ε ≫ Δt; bottom: the "
              "limit. In between, the paper's methods have plateaus proportional to ε. For md-imex-5-2 and "
              "md-imex-8-3 low orders mark the growth of errors ε²/Δt towards Δt = ε; for ε ≪ Δt the order "
              "holds. Empty: below the accuracy of the reference.",
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
          close_to(name + ": order at eps = 1, smallest steps", m.fine_slope(0), m.order, 0.15));
      // The slope is taken down to the plateau, which is at most ε.
      const std::size_t last = m.epsilon.size() - 1;
      result.findings.push_back(close_to(name + ": order at eps = 1e-8 above the plateau",
                                         m.coarse_slope(last, 3 * m.epsilon[last]), m.order, 0.25));
      result.findings.push_back(
          at_most(name + ": smallest order between", m.smallest_slope(), order_map::tolerated_loss));
    }
    result.pictures.push_back(std::move(p));
  }
  result.tables.push_back(std::move(table));
}

}  // namespace apsis::paper
