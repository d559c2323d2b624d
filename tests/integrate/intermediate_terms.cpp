// Do terms of size εΔt and those of the band ε ~ Δt agree with one step of the production stepper in 60
// digits? The coefficients predict these terms (docs/plateaus.md).
// The problem is u1' = s(u1) u2, u2' = k(u1) + C(u1)(E(u1) − u2)/ε from u1 = 0. With linear s, k, C and
// quadratic E every elementary differential is a product of slopes:
//   f = sE, g = E'f − k, Ψ = s/C;  f' = s'E + E', g'f = (E''E + E'f' − k')E, E''(f, f) = E''E², Ψ' = s' − C'.
#include "support/catalogue.hpp"

#include <apsis/integrate/problem.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/precision.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace intermediate_terms_test {

namespace {

using real = apsis::mp_real;
using state = std::array<real, 2>;

/// u1' = T1(u), u2' = T2(u) + C(u1)(E(u1) − u2)/ε in 60 digits. The problems of the library support built-in
/// types only.
struct exact_problem {
  using real = apsis::mp_real;
  using state = std::array<real, 2>;

  std::function<state(const state&)> transport;
  std::function<real(const real&)> equilibrium, rate;
  real epsilon;

  void add_transport(const real&, const state& u, std::span<const apsis::target<state, real>> targets) const {
    const state T = transport(u);
    for (const auto& to : targets)
      for (std::size_t k = 0; k < 2; ++k) (*to.acc)[k] = to.combine((*to.acc)[k], u[k], T[k]);
  }
  void solve_collision(const real&, const real& a, const real& b, state& u) const {
    if (a == 0 && b == 0) return;
    const real E = equilibrium(u[0]);
    if (epsilon == 0) {
      u[1] = E;
      return;
    }
    const real k = rate(u[0]) / epsilon, mu = a * k - b * k * k;
    u[1] = (u[1] + mu * E) / (1 + mu);
  }
  real forward_euler_step(const real&, const state&) const { return 1; }
};

struct slopes {
  double s1, e1, e2, c1, k0, k1;
};

exact_problem make(const slopes& p, const real& epsilon) {
  return {
      [p](const state& u) { return state{(1 + real(p.s1) * u[0]) * u[1], real(p.k0) + real(p.k1) * u[0]}; },
      [p](const real& w) { return real(1.25 + w * (real(p.e1) + w * real(p.e2) / 2)); },
      [p](const real& w) { return real(1 + real(p.c1) * w); }, epsilon};
}

/// Returns the result of one step from (0, v).
state stepped(const apsis::method& m, const slopes& p, const real& epsilon, const real& dt, const real& v) {
  auto problem = make(p, epsilon);
  apsis::stepper march(m, problem);
  state u = {real(0), v};
  march.step(real(0), dt, u);
  return u;
}

/// The differentials also have 60 digits, because rounding errors of g are divided by Δt.
struct differentials {
  real E = 1.25, f1, g, gf, eff, psi1;
  explicit differentials(const slopes& p)
      : f1(real(p.s1) * E + real(p.e1)),
        g(real(p.e1) * E - real(p.k0)),
        gf((real(p.e2) * E + real(p.e1) * f1 - real(p.k1)) * E),
        eff(real(p.e2) * E * E),
        psi1(real(p.s1) - real(p.c1)) {}
};

void expect_close(const real& measured, const real& predicted, const std::string& what) {
  EXPECT_LT(abs(measured - predicted), real(1e-8) * (1 + abs(predicted)))
      << what << ": " << measured.str(12) << " instead of " << predicted.str(12);
}

// Each problem has other nonzero differentials. The second one has only g'f, the third only those
// of linear problems.
const std::vector<slopes> problems = {{0.3, 0.7, 0.4, 0.9, 0.2, 0.5},  {0.0, 0.0, 0.0, 0.0, 0.6, 1.1},
                                      {0.0, 0.8, 0.0, 0.0, 0.0, 0.0},  {0.0, 0.5, 0.0, 1.3, 0.1, 0.0},
                                      {0.0, 0.5, -1.5, 0.0, 0.0, 0.0}, {-0.8, 0.2, 1.5, -0.4, 0.6, 0.0}};

class intermediate_terms : public testing::TestWithParam<std::string> {
 protected:
  const apsis::method& m = apsis::find_method(GetParam());
  apsis::intermediate_regime<real> terms = apsis::analyse_intermediate_regime(m.coefficients<real>());
  // The neglected terms have the relative sizes Δt = 4e-10 and ε/Δt² = 6e-12. The latter is larger where a
  // stage relaxes slowly.
  const real epsilon = real("1e-30"), dt = real("4e-10");
};

TEST_P(intermediate_terms, of_size_epsilon_dt_agree_with_one_step) {
  for (const auto& p : problems) {
    const differentials of(p);
    // The data have the deviation that the previous step leaves at t − Δt. This matters for ARS methods only.
    const real slope = terms.last_slope - terms.last, curvature = terms.last_curvature - terms.last_slope;
    const real y = terms.last * of.g + dt * (slope * of.gf + curvature * of.eff);
    const state with = stepped(m, p, epsilon, dt, of.E - epsilon * y);
    const state limit = stepped(m, p, real(0), dt, of.E);
    const real moved = (limit[0] - with[0]) / (epsilon * dt);
    expect_close((moved - terms.flux * of.g) / dt,
                 terms.flux_place * of.psi1 * of.E * of.g + terms.flux_slope * of.gf +
                     (terms.flux_curvature - terms.flux_slope) * of.eff + terms.flux_carried * of.f1 * of.g,
                 "flux");
    const real w = with[0], deviation = 1.25 + w * (real(p.e1) + w * real(p.e2) / 2) - with[1];
    expect_close((deviation * (1 + real(p.c1) * w) / epsilon - terms.last * of.g) / dt,
                 terms.last_slope * of.gf + curvature * of.eff, "last");
  }
}

TEST_P(intermediate_terms, of_the_layer_agree_with_one_step) {
  if (isinf(terms.layer)) return;  // u^n is a stage: O(Δt), not O(ε)
  const double D0 = 0.45;
  for (const auto& p : problems) {
    const differentials of(p);
    const state out = stepped(m, p, epsilon, dt, of.E - D0), in = stepped(m, p, epsilon, dt, of.E);
    const real moved = (in[0] - out[0]) / epsilon;
    expect_close((moved - terms.layer * D0) / dt,
                 (terms.layer_place * of.psi1 * of.E + terms.layer_carried * of.f1) * D0, "layer");
  }
}

/// u' = v, v' = (a u − v)/ε with ε = Δt/z. Do the logarithm of the slow eigenvalue of one step over Δt and
/// the second component of its eigenvector agree?
TEST_P(intermediate_terms, of_the_band_agree_with_the_hydrodynamic_mode) {
  const auto butcher = apsis::to_butcher(m.coefficients<real>());
  for (const char* z : {"0.01", "0.5", "3", "70", "1e4"}) {
    const auto at = apsis::at_finite_rate(butcher, real(z));
    // The eigenvalue is 1 + aΔt + a²(Δt²/2 − flux Δt ε) + O(a³). Second differences in a at a = 0
    // give the flux.
    const real step = 1, eps = step / real(z), a = real("1e-18");
    exact_problem problem = {[](const state& u) { return state{u[1], real(0)}; },
                             [a](const real& w) { return real(a * w); }, [](const real&) { return real(1); },
                             eps};
    apsis::stepper march(m, problem);
    state x = {real(1), real(0)}, y = {real(0), real(1)};
    march.step(real(0), step, x);
    march.step(real(0), step, y);
    const real trace = x[0] + y[1], determinant = x[0] * y[1] - y[0] * x[1];
    const real slow = trace / 2 + sqrt(trace * trace / 4 - determinant), fast = determinant / slow;
    const real place = [&] {  // Σ b̂_i ĉ_i, 1/2 for order 2
      const auto c = butcher.A_hat * std::vector<real>(m.stages(), real(1));
      return (butcher.A_hat * c).back();
    }();
    EXPECT_LT(abs((1 + a * step - slow) / (a * a * step * eps) + place * step / eps - at.flux), real(1e-12))
        << z;
    EXPECT_LT(abs((a - x[1] / (x[0] - fast)) / (a * a * eps) - at.last), real(1e-12)) << z;
  }
}

INSTANTIATE_TEST_SUITE_P(catalogue, intermediate_terms,
                         testing::ValuesIn(methods_with_an_intermediate_regime()), test_name);

/// The problem is u1' = u2² with E = cos u1. Because its transport is nonlinear in u, the integral over
/// the layer is nonlinear in D₀. It is ε/C times −2ED₀ + D₀²/2. Methods with layer = 1 reproduce the
/// linear part −2ED₀.
TEST(layer, of_nonlinear_transport_is_reproduced_in_its_linear_part) {
  const real epsilon = real("1e-20"), dt = real("1e-9"), E = cos(real("0.3")), C = 1.25, D0 = 0.5;
  exact_problem problem = {[](const state& u) { return state{u[1] * u[1], real(0)}; },
                           [](const real& w) { return real(cos(w)); }, [C](const real&) { return C; },
                           epsilon};
  for (const std::string name : {"md-imex-3-2", "md-imex-5-2", "md-imex-8-3"}) {
    apsis::stepper march(apsis::find_method(name), problem);
    state out = {real("0.3"), E - D0}, in = {real("0.3"), E};
    march.step(real(0), dt, out);
    march.step(real(0), dt, in);
    EXPECT_LT(abs((out[0] - in[0]) * C / epsilon + 2 * E * D0), real(1e-7)) << name;
  }
}

}  // namespace

}  // namespace intermediate_terms_test
