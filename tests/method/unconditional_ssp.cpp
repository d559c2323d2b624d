// Unconditional strong stability of the implicit part limits the band (docs/plateaus.md, (11) and (12)).
#include <apsis/core/random_source.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/convexity.hpp>
#include <apsis/method/intermediate_regime.hpp>

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace apsis::unconditional_ssp_test {
namespace {

/// The sums b·e, b·c and ḃ·e of the last stage.
struct sums {
  double weights = 0.0, abscissas = 0.0, second = 0.0;
};

sums of_last_stage(const shu_osher_form<double>& form) {
  const auto b = to_butcher(form);
  const std::size_t last = b.stages() - 1;
  const auto c = b.A * std::vector<double>(b.stages(), 1.0);
  sums out;
  for (std::size_t j = 0; j <= last; ++j) {
    out.weights += b.A(last, j);
    out.abscissas += b.A(last, j) * c[j];
    out.second += b.A_dot(last, j);
  }
  return out;
}

shu_osher_form<double> zeros(std::size_t stages) {
  shu_osher_form<double> form;
  form.P = form.W = form.D = matrix<double>(stages, stages);
  form.ddot.resize(stages);
  form.r = 1.0;
  return form;
}

TEST(unconditional_ssp, bounds_b_c_from_below_and_excludes_c_dot_of_zero_for_every_method_of_the_catalogue) {
  int tested = 0;
  for (const auto& name : method_names()) {
    const method& m = find_method(name);
    const auto form = m.coefficients<double>();
    if (!has_derivatives(m.kind) || m.claims.order < 2 || !is_convex(form, m.kind, form.stages())) continue;
    const sums s = of_last_stage(form);
    double implicit = 0.0;
    for (std::size_t i = 0; i < form.stages(); ++i) implicit += form.D(i, i) > 0.0 ? 1.0 : 0.0;
    // The tolerance covers the rounding of sums of 16 stages with terms of order one.
    EXPECT_NEAR(s.weights, 1.0, 1e-13) << name;
    EXPECT_GE(s.abscissas, 0.5 + 0.5 / implicit - 1e-13) << name;
    EXPECT_LE(s.second, -0.5 / implicit + 1e-13) << name;
    ++tested;
  }
  EXPECT_GE(tested, 20);
}

TEST(unconditional_ssp, attains_the_bound_with_equal_stages_in_a_chain) {
  for (const std::size_t stages : {1U, 2U, 5U, 9U}) {
    auto chain = zeros(stages);
    for (std::size_t i = 0; i < stages; ++i) {
      chain.D(i, i) = 1.0 / static_cast<double>(stages);
      if (i > 0) chain.P(i, i - 1) = 1.0;
    }
    EXPECT_NEAR(of_last_stage(chain).abscissas, 0.5 + 0.5 / static_cast<double>(stages), 1e-14);
  }
}

TEST(unconditional_ssp, bounds_b_c_of_random_convex_forms) {
  random_source source(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const auto stages = static_cast<std::size_t>(source.integer(1, 8));
    auto form = zeros(stages);
    for (std::size_t i = 0; i < stages; ++i) {
      form.D(i, i) = source.one_in(4) ? 0.0 : source.magnitude(-2, 0);
      // Row i divides its weight among the earlier stages and u^n. Half of the rows leave nothing for u^n.
      double left = 1.0;
      for (std::size_t j = i; j-- > 0;) {
        const double share =
            j == 0 && source.one_in(2) ? 1.0 : (source.one_in(3) ? 0.0 : source.magnitude(-1, 0));
        form.P(i, j) = left * share;
        left -= form.P(i, j);
      }
    }
    const double sum = of_last_stage(form).weights;
    if (!(sum > 1e-3)) continue;
    for (std::size_t i = 0; i < stages; ++i) form.D(i, i) /= sum;
    EXPECT_GE(of_last_stage(form).abscissas, 0.5 + 0.5 / static_cast<double>(stages) - 1e-12);
  }
}

TEST(finite_rate, has_exact_viscosity_and_layer_where_transport_and_collision_have_the_same_weights) {
  int tested = 0;
  for (const auto& name : method_names()) {
    const method& m = find_method(name);
    if (m.kind != method_kind::imex) continue;
    const auto b = to_butcher(m.coefficients<long double>());
    const std::size_t last = b.stages() - 1;
    bool equal = true;
    for (std::size_t j = 0; j <= last; ++j)
      equal = equal && std::abs(b.A_hat(last, j) - b.A(last, j)) < 1e-15L && b.A_dot(last, j) == 0.0L;
    if (!equal) continue;
    ++tested;
    for (const long double z : {0.1L, 1.0L, 7.0L, 1e3L}) {
      const auto at = at_finite_rate(b, z);
      // The tolerance covers the rounding of long double times z² of the stage equations.
      EXPECT_NEAR(static_cast<double>(at.flux), 1.0, 1e-11) << name;
      EXPECT_NEAR(static_cast<double>(z * at.layer), static_cast<double>(1.0L - at.decay), 1e-11) << name;
    }
  }
  EXPECT_GE(tested, 3);  // bhr-553, ssp2-222, ssp3-433
}

TEST(finite_rate, integrates_a_layer_like_repeated_steps_of_the_stage_equations) {
  // For equal steps Σ_n layer(z) R(−z)ⁿ = layer(z)/(1 − R(−z)). This tends to (7) as z → ∞ and to 1/z as
  // z → 0.
  for (const auto& name : method_names()) {
    const auto form = find_method(name).coefficients<mp_real>();
    const auto terms = analyse_intermediate_regime(form);
    if (find_method(name).kind != method_kind::imex || !terms.applies || !isfinite(terms.layer)) continue;
    const mp_real stiff = mp_real(1e21), soft = mp_real(1e-9);
    const auto large = at_finite_rate(to_butcher(form), stiff),
               small = at_finite_rate(to_butcher(form), soft);
    EXPECT_LT(abs(stiff * large.layer / (1 - large.decay) - terms.layer), mp_real(1e-15)) << name;
    EXPECT_LT(abs(soft * small.layer / (1 - small.decay) - 1), mp_real(1e-8)) << name;
  }
}

}  // namespace
}  // namespace apsis::unconditional_ssp_test
