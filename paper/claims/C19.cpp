#include <apsis/core/extremes.hpp>

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <paper/claim.hpp>
#include <paper/ode_study.hpp>
#include <paper/order_map_study.hpp>
#include <paper/plateau_study.hpp>

namespace apsis::paper {
namespace C19_claim {
namespace {

// These values resemble those of the paper's figures; the steps are 1/4 … 1/131072 = 7.6e-6.
constexpr double epsilons[] = {1, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10};
constexpr int coarsest = 2, finest = 17, levels = finest - coarsest + 1;
constexpr std::size_t epsilon_count = std::size(epsilons);

struct method_errors {
  std::string name;
  int order;
  std::vector<std::vector<double>> error;  ///< [ε][level]

  double at(double epsilon, int level) const {
    const auto e = std::find(std::begin(epsilons), std::end(epsilons), epsilon) - std::begin(epsilons);
    return error[static_cast<std::size_t>(e)][static_cast<std::size_t>(level - coarsest)];
  }
  /// Returns the slope between Δt = 2^-from and 2^-to.
  double slope(double epsilon, int from, int to) const {
    std::vector<double> part;
    for (int level = from; level <= to; ++level) part.push_back(at(epsilon, level));
    return halving_slope(part);
  }
};

std::vector<method_errors> measure(const study_control& control) {
  std::vector<method_errors> all{{"md-imex-3-2", 2, {}}, {"md-imex-6-3", 3, {}}};
  std::vector<ode_state<long double>> exact(epsilon_count);
  run_all(control, "reference solutions", static_cast<int>(epsilon_count),
          [&](int e) { exact[static_cast<std::size_t>(e)] = ode_reference(epsilons[e]); });
  for (auto& m : all) {
    m.error.assign(epsilon_count, std::vector<double>(levels));
    run_all(control, "ODE model with " + m.name, static_cast<int>(epsilon_count) * levels, [&](int job) {
      const auto e = static_cast<std::size_t>(job) % epsilon_count;
      const auto k = levels - 1 - static_cast<std::size_t>(job) / epsilon_count;  // long runs first
      const auto u = ode_solution(find_method(m.name), epsilons[e], 1L << (coarsest + static_cast<int>(k)));
      m.error[e][k] = ode_distance(u, exact[e]);
    });
  }
  return all;
}

picture figure(const method_errors& m) {
  panel p{"", "Δt (dimensionless)", "|Δu1| + |Δu2| at t = 1 (dimensionless)", true, true, {},
          {}, {m.order * 1.0}};
  for (std::size_t e = 0; e < epsilon_count; ++e) {
    curve c{fmt::format("ε = {:g}", epsilons[e]), {}, {}};
    for (std::size_t k = 0; k < levels; ++k) {
      c.x.push_back(std::ldexp(1.0, -coarsest - static_cast<int>(k)));
      c.y.push_back(m.error[e][k]);
    }
    p.curves.push_back(std::move(c));
  }
  return {
      "C19-" + m.name,
      "ODE model, " + m.name,
      fmt::format(
          "Order {} for ε = 1 and in the limit of small ε. In between, where Δt decreases from far above ε "
          "to far below, the error stalls at a plateau proportional to ε. Below 1e-13 only rounding remains.",
          m.order),
      {std::move(p)}};
}

report_table slopes(const method_errors& m) {
  report_table t{"observed order of " + m.name + " between Δt = 2^-k and 2^-(k+1)", {"k"}, {}};
  for (const double epsilon : epsilons) t.columns.push_back(fmt::format("ε = {:g}", epsilon));
  for (int k = coarsest; k < finest; ++k) {
    std::vector<std::string> row{std::to_string(k)};
    // Below 1e-13 differences measure rounding.
    for (const double epsilon : epsilons)
      row.push_back(m.at(epsilon, k + 1) > 1e-13 ? fmt::format("{:.2f}", m.slope(epsilon, k, k + 1)) : "–");
    t.rows.push_back(std::move(row));
  }
  return t;
}

/// Returns the change of the references with a tolerance ten times as large and one column fewer.
double doubt_of_references(const study_control& control) {
  std::vector<double> moved(epsilon_count);
  run_all(control, "uncertainty of the references", static_cast<int>(epsilon_count), [&](int e) {
    moved[static_cast<std::size_t>(e)] = ode_distance(
        ode_reference(epsilons[e]), ode_reference(epsilons[e], ode_data::inconsistent, {1e-12L, 0, 7}));
  });
  return maximum(moved);
}

claim_result check(const study_control& control) {
  claim_result result;
  for (const auto& m : measure(control)) {
    // The third-order method reaches its plateau, 0.3 ε, for ε = 1e-10 at Δt = 1/512. For ε = 1 it
    // reaches rounding.
    const bool second = m.order == 2;
    result.findings.push_back(close_to(m.name + ": order at eps = 1",
                                       second ? m.slope(1, 7, 13) : m.slope(1, 6, 12), m.order, 0.1));
    result.findings.push_back(close_to(m.name + ": order at eps = 1e-10",
                                       second ? m.slope(1e-10, 4, 12) : m.slope(1e-10, 3, 8), m.order, 0.1));
    for (const double epsilon : {1e-3, 1e-4})
      result.findings.push_back(
          at_most(fmt::format("{}: order from dt = 1/64 to 1/1024 at eps = {:g}", m.name, epsilon),
                  m.slope(epsilon, 6, 10), 1.0));
    // Here ε ≪ Δt, and Δt^p is far below ε.
    const double middle = m.at(1e-5, 11) / 1e-5, fine = m.at(1e-6, 13) / 1e-6;
    result.findings.push_back(
        close_to(m.name + ": error/eps on the plateau of 1e-5 over that of 1e-6", middle / fine, 1, 0.3));
    result.pictures.push_back(figure(m));
    result.tables.push_back(slopes(m));
  }
  // The looser reference has errors up to 1e-13; see its test.
  result.findings.push_back(at_most("change of the reference with another order and tolerance",
                                    doubt_of_references(control), 2e-13));
  add_plateau_study("C19", control, result);
  add_order_maps("C19", control, result);
  return result;
}

}  // namespace
}  // namespace C19_claim

extern const claim_entry claim_C19;
const claim_entry claim_C19 = {
    .id = "C19",
    .section = "Numerical results, an ODE model",
    .statement =
        "orders 2 and 3 at eps = 1 and eps = 1e-10; order reduction between; plateaus of size O(eps)",
    .how =
        "error at t = 1 against a reference accurate to 1e-13, for Δt from 1/4 to 7.6e-6; cause of the "
        "plateaus; observed order over ε and Δt for all models",
    .check = C19_claim::check};

}  // namespace apsis::paper
