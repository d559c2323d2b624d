// SSP coefficients agree with independent formulas: random Shu–Osher forms, θ methods, stability polynomials.
#include <apsis/method/monotonicity.hpp>

#include "tableaux.hpp"

#include <algorithm>

#include <support/property.hpp>

namespace apsis::test::monotonicity_test {
namespace {

const mp_real zero("1e-45");  // the input is dyadic and exact, the arithmetic has sixty digits

struct random_form {
  shu_osher_form<mp_real> form;
  mp_real r;             ///< min over w_ij > 0 of r (p_ij + w_ij)/w_ij
  bool bounded = false;  ///< some w_ij > 0
};

/// Returns a form with the signs of the theorem: weights k/1024 with row sums below 1, d ≥ 0 ≥ ḋ, not both 0.
random_form draw_form(std::size_t s) {
  const auto dyadic = [](int low, int high) { return mp_real(*rc::gen::inRange(low, high)) / 1024; };
  random_form m;
  auto& f = m.form;
  f.P = f.W = f.D = matrix<mp_real>(s, s);
  f.r = dyadic(64, 4096);
  for (std::size_t i = 0; i < s; ++i) {
    const int which = *rc::gen::inRange(0, 3);
    f.D(i, i) = which == 0 ? mp_real(0) : dyadic(1, 2048);
    f.ddot.push_back(which == 1 ? mp_real(0) : -dyadic(1, 2048));
    for (std::size_t j = 0; j < i; ++j) {
      f.P(i, j) = dyadic(0, 1 + 512 / static_cast<int>(s));
      f.W(i, j) = *rc::gen::arbitrary<bool>() ? mp_real(0) : dyadic(1, 2 + 500 / static_cast<int>(s));
      if (f.W(i, j) == 0) continue;
      const mp_real ratio = f.r * (f.P(i, j) + f.W(i, j)) / f.W(i, j);
      if (!m.bounded || ratio < m.r) m.r = ratio;
      m.bounded = true;
    }
  }
  return m;
}

std::string named(const char* what, std::size_t i, std::size_t j) {
  return what + std::string("_") + std::to_string(i + 1) + "," + std::to_string(j + 1) + " = ";
}

TEST(monotonicity, recovers_the_coefficient_of_random_forms_from_their_butcher_forms) {
  check_property("r = min r₀ (P + W)/W", [] {
    const auto m = draw_form(*rc::gen::inRange<std::size_t>(1, 8));
    const auto found = analyse_imex(to_butcher(m.form), zero);
    RC_ASSERT(found.exists);
    RC_ASSERT(found.unconditional);
    RC_ASSERT(found.bounded == m.bounded);
    if (m.bounded) RC_ASSERT(abs(found.coefficient - m.r) < mp_real("1e-40") * m.r);
  });
}

TEST(monotonicity, names_any_entry_of_wrong_sign) {
  check_property("one entry of the wrong sign", [] {
    const auto s = *rc::gen::inRange<std::size_t>(2, 8);
    auto form = draw_form(s).form;
    const auto i = *rc::gen::inRange<std::size_t>(1, s);
    const auto j = *rc::gen::inRange<std::size_t>(0, i);
    std::string entry;
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        form.P(i, j) = -form.W(i, j) - mp_real(1) / 1024;
        entry = named("R", i, j);
        break;
      case 1:
        form.P(i, j) += form.W(i, j) + mp_real(1) / 1024;  // R_ij < 0 for any W_ij
        form.W(i, j) = -mp_real(1) / 1024;
        entry = named("(R A_hat)", i, j);
        break;
      case 2:
        form.D(i, i) = -mp_real(1) / 1024;
        entry = named("A", i, i);
        break;
      default:
        form.ddot[i] = mp_real(1) / 1024;
        entry = named("Adot", i, i);
    }
    const auto found = analyse_imex(to_butcher(form), zero);
    RC_ASSERT(!found.exists);
    RC_ASSERT(!found.unconditional);
    RC_ASSERT(found.forbids.find(entry) == 0U);
  });
}

TEST(monotonicity, radius_of_theta_methods_is_1_over_1_minus_theta) {
  check_property("u' = u^n + Δt ((1 − θ) Q(u^n) + θ Q(u'))", [] {
    const mp_real theta = mp_real(*rc::gen::inRange(0, 1000)) / 1000;
    butcher_form<mp_real> b{matrix<mp_real>(2, 2), matrix<mp_real>(2, 2), matrix<mp_real>(2, 2)};
    b.A(1, 0) = 1 - theta;
    b.A(1, 1) = theta;
    RC_ASSERT(abs(monotonicity_radius(b.A, zero) * (1 - theta) - 1) < mp_real("1e-40"));
    // For every θ the method is outside the paper's class, because Q(u^n) enters explicitly.
    const auto found = analyse_imex(b, zero);
    RC_ASSERT(!found.exists);
    RC_ASSERT(!found.unconditional);
    RC_ASSERT(found.forbids.find("A_2,1 = ") == 0U);
  });
}

TEST(monotonicity, of_backward_euler_is_unconditional) {
  matrix<mp_real> A(1, 1);
  A(0, 0) = 1;
  EXPECT_GE(monotonicity_radius(A, zero), mp_real(1e6));
}

/// Returns true if all derivatives of the stability polynomial ψ(z) = Σ z^k/k! at −x are ≥ 0. This holds for
/// x up to its threshold factor, an upper bound of r.
bool absolutely_monotonic(int degree, double x) {
  for (int derivative = 0; derivative <= degree; ++derivative) {
    double sum = 0, term = 1;
    for (int k = 0; k <= degree - derivative; ++k) {
      sum += term;
      term *= -x / (k + 1);
    }
    if (sum < 0) return false;
  }
  return true;
}

TEST(monotonicity, of_explicit_methods_lies_between_the_bounds_by_form_and_polynomial) {
  for (const auto& [name, stages] : {std::pair{"ssprk-2-2", 2}, std::pair{"ssprk-3-3", 3}}) {
    const auto form = find_method(name).coefficients<mp_real>();
    // For a lower bound, the weights of the file are convex with r = 1.
    for (const auto& weight : initial_weights(form)) EXPECT_GE(weight, 0) << name;
    for (std::size_t i = 0; i < form.stages(); ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE(std::min(form.P(i, j), form.W(i, j)), 0) << name;
    EXPECT_EQ(form.r, 1) << name;
    // For an upper bound, no method with this polynomial has r > 1.
    EXPECT_TRUE(absolutely_monotonic(stages, 1.0)) << name;
    EXPECT_FALSE(absolutely_monotonic(stages, 1.0 + 1e-9)) << name;
    // Bisection on the tableau must therefore find r = 1.
    EXPECT_LT(abs(monotonicity_radius(to_butcher(form).A_hat, zero) - 1), mp_real("1e-40")) << name;
  }
}

}  // namespace
}  // namespace apsis::test::monotonicity_test
