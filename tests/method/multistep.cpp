// Multistep methods as data: published error constants, roots, names and refusals.
#include <apsis/method/multistep.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/method/two_step.hpp>

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace multistep_test {

using testing::HasSubstr;

TEST(multistep, imex_bdf_has_the_orders_and_error_constants_of_the_literature) {
  // The constant of BDF is −1/(k + 1) for Σ_j ∇^j u/j = Δt u' (Hairer, Nørsett, Wanner, Solving Ordinary
  // Differential Equations I, table III.2.2 after division by σ(1)). Extrapolation of u' from t_n, …,
  // t_{n+1−k} leaves Δt^k u^{(k+1)}, the factor of ∇^k u'.
  for (int k = 1; k <= 5; ++k) {
    const auto found = apsis::find_multistep_orders(apsis::imex_bdf_coefficients<apsis::mp_real>(k));
    EXPECT_EQ(found.order, k);
    EXPECT_NEAR(static_cast<double>(found.implicit_constant), -1.0 / (k + 1), 1e-15) << k;
    EXPECT_NEAR(static_cast<double>(found.explicit_constant), 1.0 - 1.0 / (k + 1), 1e-15) << k;
  }
}

TEST(multistep, a_wrong_coefficient_lowers_the_order) {
  for (const bool of_transport : {false, true}) {
    auto m = apsis::imex_bdf_coefficients<apsis::mp_real>(4);
    (of_transport ? m.c[2] : m.b) += apsis::mp_real("1e-30");
    EXPECT_EQ(apsis::find_multistep_orders(m).order, 0);
  }
}

TEST(multistep, errors_grow_as_the_roots_say) {
  EXPECT_EQ(apsis::error_amplification({1.0}), 1.0);
  // h_n − h_{n−1} = (−b)^n.
  EXPECT_NEAR(apsis::error_amplification({1.25, -0.25}), 1.0 / 0.75, 1e-14);
  EXPECT_NEAR(apsis::error_amplification({0.5, 0.5}), 1.0 / 0.5, 1e-14);
  // BDF of order 2 has the roots 1 and 1/3.
  EXPECT_NEAR(apsis::error_amplification(apsis::find_multistep_method("imex-bdf-2").weights), 1.5, 1e-14);
}

TEST(multistep, every_listed_method_is_found_and_has_consistent_data) {
  const auto names = apsis::multistep_method_names();
  ASSERT_GE(names.size(), 7U);
  for (const auto& name : names) {
    const auto m = apsis::find_multistep_method(name);
    EXPECT_EQ(m.name, name);
    EXPECT_TRUE(apsis::is_multistep_method(name));
    EXPECT_FALSE(apsis::is_method_name(name)) << "a method of one step has this name";
    EXPECT_GE(apsis::find_method(m.starter).claims.order, m.order) << name;
    EXPECT_EQ(apsis::order_of_method(name), m.order);
    double sum = 0.0;
    for (const double weight : m.weights) sum += weight;
    EXPECT_NEAR(sum, 1.0, 1e-15) << name;
    EXPECT_EQ(m.ssp_coefficient > 0.0, m.rows.has_value() || m.steps == 1) << name;
  }
  EXPECT_FALSE(apsis::is_multistep_method("md-imex-6-3"));
  EXPECT_FALSE(apsis::is_multistep_method("imex-bdf-6"));
  EXPECT_EQ(apsis::order_of_method("md-imex-6-3"), 3);
}

TEST(multistep, unknown_names_are_refused_with_the_closest_one) {
  EXPECT_THAT([] { static_cast<void>(apsis::find_multistep_method("imex-bdf-6")); },
              testing::ThrowsMessage<apsis::input_error>(
                  HasSubstr("unknown multistep method 'imex-bdf-6'; did you mean 'imex-bdf-1'?")));
}

}  // namespace multistep_test
