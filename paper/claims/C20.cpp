#include <string>
#include <utility>

#include <fmt/format.h>
#include <paper/claim.hpp>
#include <paper/ode_study.hpp>

namespace apsis::paper {
namespace C20_claim {
namespace {

constexpr double epsilon = 1e-6;
constexpr int coarsest = 4, finest = 14;  // Δt = 2^-k, far above ε

struct stage_of_paper {
  const char* method;
  int order;
  int plateau;  ///< the error is flat from Δt = 2^-plateau on
  int from,
      to;  ///< levels at which self-convergence is measured, above rounding and the O(ε/Δt) end of
           ///< the plateau
};
constexpr stage_of_paper methods[] = {{"md-imex-3-2", 2, 11, 6, 12}, {"md-imex-6-3", 3, 6, 4, 8}};

claim_result check(const study_control& control) {
  claim_result result;
  const auto exact = ode_reference(epsilon);
  for (const auto& m : methods) {
    constexpr int count = finest - coarsest + 1;
    std::vector<ode_state<double>> u(count);
    run_all(control, std::string("ODE model with ") + m.method, count, [&](int k) {
      u[static_cast<std::size_t>(k)] = ode_solution(find_method(m.method), epsilon, 1L << (coarsest + k));
    });
    report_table table{fmt::format("{}, eps = {:g}", m.method, epsilon),
                       {"Δt", "error", "order", "|u(Δt) − u(Δt/2)|", "order"},
                       {}};
    curve errors{"error", {}, {}}, changes{"change from Δt to Δt/2", {}, {}};
    const auto part = [&](const curve& c, int from, int to) {
      return std::vector<double>(c.y.begin() + (from - coarsest), c.y.begin() + (to - coarsest) + 1);
    };
    for (std::size_t k = 0; k + 1 < u.size(); ++k) {
      const double dt = std::ldexp(1.0, -coarsest - static_cast<int>(k));
      errors.x.push_back(dt);
      changes.x.push_back(dt);
      errors.y.push_back(ode_distance(u[k], exact));
      changes.y.push_back(ode_distance(u[k], u[k + 1]));
      const auto order = [&](const curve& c) {
        return k > 0 ? fmt::format("{:.2f}", std::log2(c.y[k - 1] / c.y[k])) : std::string();
      };
      table.rows.push_back({fmt::format("{:g}", dt), fmt::format("{:.3e}", errors.y[k]), order(errors),
                            fmt::format("{:.3e}", changes.y[k]), order(changes)});
    }
    const auto name = std::string(m.method);
    result.findings.push_back(at_most(name + ": order of the error on the plateau",
                                      halving_slope(part(errors, m.plateau, m.plateau + 2)), 0.5));
    result.findings.push_back(close_to(name + ": order of the change from dt to dt/2",
                                       halving_slope(part(changes, m.from, m.to - 1)), m.order, 0.15));
    result.tables.push_back(std::move(table));
    panel p{"", "Δt (dimensionless)", "|Δu1| + |Δu2| at t = 1 (dimensionless)", true, true, {},
            {}, {m.order * 1.0}};
    p.curves = {std::move(errors), std::move(changes)};
    result.pictures.push_back(
        {"C20-" + name,
         name + fmt::format(" at ε = {:g}", epsilon),
         "The error stalls at a plateau, while the difference of runs with Δt and Δt/2 still decreases with "
         "the order of the method: they converge to another solution, O(ε) away.",
         {std::move(p)}});
  }
  return result;
}

}  // namespace
}  // namespace C20_claim

extern const claim_entry claim_C20;
const claim_entry claim_C20 = {
    .id = "C20",
    .section = "Numerical results, an ODE model",
    .statement = "on the plateaus the methods still converge with their order, if Δt is compared with Δt/2",
    .how = "self-convergence at eps = 1e-6 where the error against the reference is flat",
    .check = C20_claim::check};

}  // namespace apsis::paper
