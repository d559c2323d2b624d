#pragma once

#include <apsis/integrate/evolution.hpp>
#include <apsis/integrate/relaxation_problem.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <integrate/ode_model.hpp>

/// Evolutions of the ODE model and of an oscillator for tests.
namespace evolution_test {

using state = std::vector<double>;
using rule = apsis::step_rule<double>;
using model = decltype(ode_model::as_relaxation<state>(0.3));
using evolution = apsis::evolution<model>;
using end = apsis::evolution_end;

inline const std::vector<std::string> of_each_kind = {"md-imex-8-3-mixed", "dop853", "exponential-2",
                                                      "imex-bdf-4", "two-step-8-3-narrow"};
inline constexpr std::array times = {0.0, 0.25, 0.5, 1.0};
inline constexpr double dt = 1.0 / 64;

inline double difference(const state& u, const state& v) {
  return std::max(std::abs(u[0] - v[0]), std::abs(u[1] - v[1]));
}

inline evolution::tolerance within(double tolerance) {
  return {tolerance, difference};
}

/// u1' = u2, u2' = −u1 from (1, 0) as transport alone. The solution is u = (cos t, −sin t).
inline auto oscillator() {
  return apsis::relaxation_problem([](double, const state& u, state& out) { out = {u[1], -u[0]}; },
                                   [](const state& u) { return u; }, [](const state& w, state& e) { e = w; },
                                   [](const state&) { return 0.0; }, 1.0);
}
using oscillation = apsis::evolution<decltype(oscillator())>;

}  // namespace evolution_test
