// Accuracy of the catalogue in each arithmetic.
#include "tableaux.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/monotonicity.hpp>
#include <apsis/method/order_conditions.hpp>
#include <apsis/method/polish.hpp>

#include <cmath>
#include <ctime>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

namespace apsis::test::precision_test {
namespace {

TEST(catalogue, has_residuals_below_1e_38_and_satisfies_its_claims) {
  for (const auto& name : method_names()) {
    const auto& c = find_certificate(name);
    EXPECT_TRUE(c.claims_hold) << name;
    EXPECT_LT(c.order_residual, mp_real("1e-38")) << name;
    EXPECT_FALSE(c.next.empty()) << name;
  }
}

TEST(catalogue, is_certified_in_a_few_seconds_of_cpu_time) {
  const std::clock_t start = std::clock();
  for (const auto& name : method_names()) certify(parse_method(catalogue_text(name), name));
  // Certification takes about 1 s. The limit allows for an unoptimized build. The test measures CPU time,
  // because other programs may load the machine.
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 5.0);
}

TEST(catalogue, returns_the_same_method_to_every_thread) {
  std::vector<const method*> found(8, nullptr);
  std::vector<std::thread> threads;
  for (auto& place : found) threads.emplace_back([&place] { place = &find_method("ssprk-3-3"); });
  for (auto& thread : threads) thread.join();
  for (const auto* m : found) EXPECT_EQ(m, &find_method("ssprk-3-3"));
}

/// The sum has a different order. On a common grid every partial sum is exact, so the order does not matter.
template <class Real>
void expect_exact_rows(const method& m) {
  const auto form = m.coefficients<Real>();
  const auto exact = m.coefficients<mp_real>();
  const auto initial = initial_weights(form);
  for (std::size_t i = 0; i < m.stages(); ++i) {
    // Only methods without an SSP coefficient have negative weights, and these must not come from rounding.
    EXPECT_EQ(initial[i] < Real(0), initial_weights(exact)[i] < mp_real(-1e-40)) << m.name << i;
    Real sum = initial[i];
    for (std::size_t j = i; j-- > 0;) sum += form.W(i, j) + form.P(i, j);
    EXPECT_EQ(sum, Real(1)) << m.name << i;
    if (abs(initial_weights(exact)[i]) < mp_real(1e-40)) {
      EXPECT_EQ(initial[i], Real(0)) << m.name << i;
    }
    for (std::size_t j = 0; j < i; ++j)
      for (const auto part : {&shu_osher_form<std::string>::P, &shu_osher_form<std::string>::W}) {
        const Real value = part == &shu_osher_form<std::string>::P ? form.P(i, j) : form.W(i, j);
        const mp_real wanted = coefficient_value((m.exact.*part)(i, j));
        // The grid is epsilon/2. Each weight is off by at most half of it, or by half a unit in the last
        // place if it is above 1. The largest weight of a row takes the remainder.
        const mp_real half = mp_real(std::numeric_limits<Real>::epsilon()) / 4;
        EXPECT_LE(abs(mp_real(value) - wanted), half * (mp_real(i + 2) + 2 * abs(wanted)))
            << m.name << i << j;
        EXPECT_EQ(value == 0, wanted == 0) << m.name;
      }
  }
}

TEST(coefficients, have_row_sums_of_exactly_1) {
  for (const auto& name : method_names()) {
    expect_exact_rows<double>(find_method(name));
    expect_exact_rows<long double>(find_method(name));
  }
}

TEST(coefficients, off_the_grid_are_correctly_rounded) {
  for (const auto& name : method_names()) {
    const method& m = find_method(name);
    if (m.kind == method_kind::explicit_only) continue;
    const auto form = m.coefficients<double>();
    for (std::size_t i = 0; i < m.stages(); ++i) {
      EXPECT_EQ(form.ddot[i], coefficient_value(m.exact.ddot[i]).convert_to<double>());
      for (std::size_t j = 0; j <= i; ++j)
        EXPECT_EQ(form.D(i, j), coefficient_value(m.exact.D(i, j)).convert_to<double>());
    }
  }
}

TEST(coefficients, of_rows_that_nearly_sum_to_1_leave_no_negative_weight_for_u_n) {
  // There are thirty weights, each rounded separately. Their sum could exceed 1 by several ulps.
  std::string p = "P = [[]", d = "d = [\"1\"", ddot = "ddot = [\"-1/2\"";
  for (int i = 1; i <= 30; ++i) {
    p += ", [";
    for (int j = 0; j < i; ++j)
      p += j == 0 ? "\"1/" + std::to_string(i) + "\"" : ", \"1/" + std::to_string(i) + "\"";
    p += "]";
    d += ", \"1\"";
    ddot += ", \"-1/2\"";
  }
  const method m = parse_method(
      "name = \"x\"\ntitle = \"\"\ncitation = \"\"\nkind = \"implicit\"\n[claims]\n"
      "order = 1\n[shu_osher]\n" +
          p + "]\n" + d + "]\n" + ddot + "]\n",
      "x");
  expect_exact_rows<double>(m);
  expect_exact_rows<long double>(m);
}

TEST(coefficients, do_not_round_to_a_sum_above_1) {
  // The weights are three thirds minus 1e-20. Each third rounds up on the grid, so the plain sum would be
  // 1 + 2⁻⁵³.
  const std::string third = "\"33333333333333333333/100000000000000000000\"";
  std::string text = catalogue_text("imdrk-1-2");
  const auto form = text.find("\n[shu_osher]");
  ASSERT_NE(form, std::string::npos);
  const method m = parse_method(
      text.substr(0, form) + "\n[shu_osher]\nP = [[], [\"1\"], [\"1\", \"0\"], [" + third + ", " + third +
          ", " + third + "]]\nd = [\"1\", \"1\", \"1\", \"1\"]\nddot = [\"-1\", \"-1\", \"-1\", \"-1\"]\n",
      "thirds");
  expect_exact_rows<double>(m);
  expect_exact_rows<long double>(m);
}

TEST(polishing, does_not_change_exact_methods) {
  for (const std::string name : {"imdrk-1-2", "imdrk-2-3", "md-imex-3-2"}) {
    const auto result = polish(find_method(name));
    EXPECT_EQ(result.largest_move, 0) << name;
  }
}

TEST(polishing, rejects_inconsistent_coefficients) {
  method m = find_method("md-imex-6-3");
  m.exact.D(0, 0) = "1";  // c_1 = 1 but ĉ_1 = 0 for any decimals
  EXPECT_THROW(polish(m), numerical_error);
}

matrix<mp_real> explicit_tableau(std::size_t s, const std::vector<std::vector<const char*>>& rows) {
  matrix<mp_real> K(s, s);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows[i].size(); ++j) K(i, j) = coefficient_value(rows[i][j]);
  return K;
}

TEST(monotonicity, radii_agree_with_the_literature) {
  const mp_real zero(1e-50);
  const auto radius = [&](const matrix<mp_real>& K) {
    return monotonicity_radius(K, zero).convert_to<double>();
  };
  // The radii are 1 for forward Euler, 2 for SSPRK(3,2) and SSPRK(4,3), and 0 for the classical fourth-order
  // method (Kraaijevanger 1991).
  EXPECT_DOUBLE_EQ(radius(explicit_tableau(2, {{}, {"1"}})), 1.0);
  EXPECT_DOUBLE_EQ(radius(explicit_tableau(4, {{}, {"1/2"}, {"1/2", "1/2"}, {"1/3", "1/3", "1/3"}})), 2.0);
  EXPECT_DOUBLE_EQ(
      radius(explicit_tableau(
          5, {{}, {"1/2"}, {"1/2", "1/2"}, {"1/6", "1/6", "1/6"}, {"1/6", "1/6", "1/6", "1/2"}})),
      2.0);
  EXPECT_EQ(
      radius(explicit_tableau(5, {{}, {"1/2"}, {"0", "1/2"}, {"0", "0", "1"}, {"1/6", "1/3", "1/3", "1/6"}})),
      0.0);
}

}  // namespace
}  // namespace apsis::test::precision_test
