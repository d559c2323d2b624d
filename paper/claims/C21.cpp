#include <string>
#include <utility>

#include <fmt/format.h>
#include <paper/claim.hpp>
#include <paper/ode_study.hpp>

namespace apsis::paper {
namespace C21_claim {
namespace {

/// Returns the solution by the third-order method with the printed coefficients and the closed form of the
/// stage. The coefficients have 15 digits, in double; their rows sum to 1 only up to rounding.
ode_state<double> solve_as_printed(double epsilon, long steps) {
  using row = std::array<double, 6>;
  constexpr double r = 0.904402174130635;
  constexpr row initial{1, 0.688151680893388, 0, 0.583517183806433, 0, 0};
  constexpr row d{0, 2, 0.388820513661584, 0.083529464436389, 1.793313488277995, 0};
  constexpr row d_dot{0.871358934880525, 0.856842702601821, 0, 0, 2, 0.205134529930013};
  constexpr std::array<row, 6> w{{{},
                                  {0.058453072749259},
                                  {0.764266518291495},
                                  {0, 0, 0.292520982667463},
                                  {0.173788618990251, 0, 0, 0.281050180194829},
                                  {0.016811671845949, 0, 0, 0.448630511341543}}};
  constexpr std::array<row, 6> p{{{},
                                  {0.253395246357353},
                                  {0, 0.235733481708505},
                                  {0, 0.123961833526104},
                                  {0.409037644509411, 0.136123556305509},
                                  {0.203353399602184, 0, 0, 0, 0.331204417210324}}};
  const double dt = 1 / static_cast<double>(steps);
  auto u = ode_initial(ode_data::inconsistent, epsilon);
  for (long n = 0; n < steps; ++n) {
    std::array<ode_state<double>, 6> stage{};
    for (std::size_t i = 0; i < 6; ++i) {
      double first = initial[i] * u[0], second = initial[i] * u[1];
      for (std::size_t j = 0; j < i; ++j) {
        first += p[i][j] * stage[j][0] + w[i][j] * (stage[j][0] + dt / r * stage[j][1]);
        second += (p[i][j] + w[i][j]) * stage[j][1];
      }
      const double k = dt * (1 + first * first) / epsilon, mu = d[i] * k + d_dot[i] * k * k;
      stage[i] = {first, (second + mu * std::sin(first)) / (1 + mu)};
    }
    u = stage[5];
  }
  return u;
}

constexpr long coarsest = 625, doublings = 9;  // Δt = 1/625 … 1/320000, among them 5e-5 = 1/20000
enum arithmetic { printed, catalogue, extended };
constexpr const char* names[] = {"15 printed digits, double", "rows summing to 1, double", "long double"};

claim_result check(const study_control& control) {
  const auto& m = find_method("md-imex-6-3");
  const auto exact =
      ode_reference(1.0, ode_data::inconsistent, {1e-15L, 0, 6});  // errors down to 1e-15 are measured
  std::vector<std::vector<double>> error(3, std::vector<double>(doublings + 1));
  run_all(control, "round-off of the third-order method", 3 * (doublings + 1), [&](int job) {
    const int how = job % 3;
    const auto k = static_cast<std::size_t>(doublings - job / 3);  // long runs first
    const long steps = coarsest << k;
    double& e = error[static_cast<std::size_t>(how)][k];
    if (how == printed) e = ode_distance(solve_as_printed(1.0, steps), exact);
    if (how == catalogue) e = ode_distance(ode_solution(m, 1.0, steps), exact);
    if (how == extended) e = ode_distance(ode_solution(m, 1.0L, steps), exact);
  });
  const auto at = [&](arithmetic how, long steps) {
    std::size_t k = 0;
    while ((coarsest << k) < steps) ++k;
    return error[how][k];
  };

  claim_result result;
  result.findings = {
      at_least("as printed: error at dt = 2e-4 over that at 5e-5", at(printed, 5000) / at(printed, 20000), 4),
      // In between, roundings of different sign may cancel. Then the missing 1e-16 of the rows dominates. It
      // is lost again in every step, so that the error grows in proportion to the number of steps.
      at_least("as printed: error at dt = 1.25e-5 over that at 5e-5", at(printed, 80000) / at(printed, 20000),
               1.5),
      close_to("as printed: growth of the error from dt = 1.25e-5 to a quarter of it",
               at(printed, 320000) / at(printed, 80000), 4, 1),
      at_most("rows summing to 1, double: its error at dt = 3.1e-6 over that as printed",
              at(catalogue, 320000) / at(printed, 320000), 0.1),
      at_most("rows summing to 1, double: error at dt = 3.1e-6 over that at 5e-5",
              at(catalogue, 320000) / at(catalogue, 20000), 1),
      // For smaller steps the reference itself is not accurate enough.
      close_to("long double: order between dt = 5e-5 and 1.25e-5",
               halving_slope({at(extended, 20000), at(extended, 40000), at(extended, 80000)}), 3, 0.1)};
  panel p{"", "Δt (dimensionless)", "|Δu1| + |Δu2| at t = 1 (dimensionless)", true, true, {}, {}, {3}};
  report_table table{"error at t = 1, eps = 1", {"Δt"}, std::vector<std::vector<std::string>>(doublings + 1)};
  for (std::size_t how = 0; how < 3; ++how) {
    table.columns.push_back(names[how]);
    curve c{names[how], {}, error[how]};
    for (std::size_t k = 0; k <= doublings; ++k) {
      c.x.push_back(1 / static_cast<double>(coarsest << k));
      if (how == 0) table.rows[k].push_back(fmt::format("{:g}", c.x.back()));
      table.rows[k].push_back(fmt::format("{:.2e}", error[how][k]));
    }
    p.curves.push_back(std::move(c));
  }
  result.tables.push_back(std::move(table));
  result.pictures.push_back(
      {"C21-round-off",
       "md-imex-6-3 at ε = 1: rounding, and what removes it",
       "With 15 printed digits the rows of coefficients miss 1 by about 1e-16, which is lost in every step: "
       "the error grows below Δt ≈ 5e-5. Coefficients whose rows sum to 1 without rounding remove the growth "
       "in double; long double removes the floor.",
       {std::move(p)}});
  return result;
}

}  // namespace
}  // namespace C21_claim

extern const claim_entry claim_C21;
const claim_entry claim_C21 = {
    .id = "C21",
    .section = "Numerical results, an ODE model",
    .statement = "third order: below Δt ≈ 5e-5 the error grows again because of round-off",
    .how =
        "shown with the printed digits; removed by coefficients whose rows sum to 1 exactly, and by long "
        "double",
    .check = C21_claim::check};

}  // namespace apsis::paper
