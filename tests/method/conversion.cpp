// The Shu–Osher forms of the catalogue follow from their Butcher forms. Random forms are in properties.cpp.
#include "tableaux.hpp"

#include <apsis/method/coefficient.hpp>

#include <gtest/gtest.h>

namespace apsis::test::conversion_test {
namespace {

void expect_same(const shu_osher_form<mp_real>& a, const shu_osher_form<mp_real>& b,
                 const std::string& name) {
  // The numbers have sixty digits. Two triangular inverses lose a few of them.
  const mp_real rounding("1e-55");
  EXPECT_EQ(a.r, b.r) << name;
  for (std::size_t i = 0; i < a.stages(); ++i) {
    EXPECT_LT(abs(a.ddot[i] - b.ddot[i]), rounding) << name << i;
    for (std::size_t j = 0; j <= i; ++j) {
      EXPECT_LT(abs(a.P(i, j) - b.P(i, j)), rounding) << name << i << j;
      EXPECT_LT(abs(a.W(i, j) - b.W(i, j)), rounding) << name << i << j;
      EXPECT_LT(abs(a.D(i, j) - b.D(i, j)), rounding) << name << i << j;
    }
  }
}

TEST(conversion, recovers_every_method_of_the_catalogue) {
  for (const auto& name : method_names()) {
    const auto form = find_method(name).coefficients<mp_real>();
    auto R = matrix<mp_real>::identity(form.stages());
    for (std::size_t i = 0; i < form.stages(); ++i)
      for (std::size_t j = 0; j < i; ++j) R(i, j) = -form.P(i, j) - form.W(i, j);
    expect_same(to_shu_osher(to_butcher(form), R, form.r), form, name);
  }
}

TEST(conversion, recovers_the_form_of_the_papers_methods_without_R) {
  // D and Ḋ are diagonal, so each column of A = R⁻¹D or of Ȧ = R⁻¹Ḋ is a multiple of the column of R⁻¹.
  for (const std::string name : {"imdrk-1-2", "imdrk-2-3", "imdrk-5-4", "md-imex-3-2", "md-imex-6-3"}) {
    const auto form = find_method(name).coefficients<mp_real>();
    const auto b = to_butcher(form);
    auto inverse = matrix<mp_real>::identity(b.stages());
    for (std::size_t j = 0; j < b.stages(); ++j) {
      const auto& source = b.A(j, j) != 0 ? b.A : b.A_dot;
      ASSERT_NE(source(j, j), 0) << name << j;
      for (std::size_t i = j + 1; i < b.stages(); ++i) inverse(i, j) = source(i, j) / source(j, j);
    }
    expect_same(to_shu_osher(b, inverse_lower(inverse), form.r), form, name);
  }
}

TEST(conversion, expresses_derivatives_of_earlier_stages_by_their_values) {
  // u_2 = u^n + Δt Q(u_2) − Δt²/3 Q̇(u_1) − Δt²/6 Q̇(u_2), and the first stage gives −Δt²/8 Q̇(u_1).
  const method& m = find_method("imdrk-2-4");
  EXPECT_TRUE(m.is_tableau());
  EXPECT_EQ(m.exact.P(1, 0), "8/3");
  EXPECT_EQ(m.exact.D(1, 0), "-4/3");
  EXPECT_EQ(m.exact.D(0, 0), "1/2");
  EXPECT_EQ(m.exact.D(1, 1), "1");
  EXPECT_EQ(m.exact.ddot, (std::vector<std::string>{"-1/8", "-1/6"}));
  const auto b = to_butcher(m.coefficients<mp_real>());
  EXPECT_LT(abs(b.A(1, 0)), mp_real("1e-55"));
  EXPECT_LT(abs(b.A_dot(1, 0) + mp_real(1) / 3), mp_real("1e-55"));
}

TEST(conversion, writes_rationals_as_quotients_and_other_numbers_as_decimals) {
  EXPECT_EQ(coefficient_text(mp_real(-4) / 3, 50), "-4/3");
  EXPECT_EQ(coefficient_text(mp_real(355) / 113, 50), "355/113");
  EXPECT_EQ(coefficient_text(mp_real(999983) / 999979, 50), "999983/999979");
  EXPECT_EQ(coefficient_text(mp_real(7), 50), "7");
  EXPECT_EQ(coefficient_text(mp_real(0), 50), "0");
  EXPECT_EQ(coefficient_text(sqrt(mp_real(2)), 20), "1.41421356237309504880");
  EXPECT_EQ(coefficient_text(mp_real(1) / 1000003, 12), "0.000000999997");
  EXPECT_EQ(coefficient_text(mp_real("1e9") + mp_real(1) / 3, 3), "1000000000.333");
}

}  // namespace
}  // namespace apsis::test::conversion_test
