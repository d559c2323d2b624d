// Time integrators of every kind as data: published error constants, roots, requirements, names and refusals.
#include <apsis/method/time_integrator.hpp>

#include <apsis/core/embedded.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/integrator_kind_registry.hpp>
#include <apsis/method/kinds/imex_bdf.hpp>
#include <apsis/method/kinds/imex_dimsim.hpp>
#include <apsis/method/kinds/two_step.hpp>
#include <apsis/method/linear_formula.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace time_integrator_test {

using testing::HasSubstr;

TEST(time_integrator, imex_bdf_has_the_orders_and_error_constants_of_the_literature) {
  // The constant of BDF for Σ_j ∇^j u/j = Δt u' is −1/(k + 1) (Hairer, Nørsett, Wanner, Solving Ordinary
  // Differential Equations I, table III.2.2 after division by σ(1)). Extrapolation of u' from t_n, …,
  // t_{n+1−k} leaves Δt^k u^{(k+1)}, the factor of ∇^k u'.
  for (int k = 1; k <= 5; ++k) {
    const auto found = apsis::compute_formula_orders(apsis::imex_bdf_coefficients<apsis::mp_real>(k));
    EXPECT_EQ(found.order, k);
    EXPECT_NEAR(static_cast<double>(found.implicit_constant), -1.0 / (k + 1), 1e-15) << k;
    EXPECT_NEAR(static_cast<double>(found.explicit_constant), 1.0 - 1.0 / (k + 1), 1e-15) << k;
  }
}

TEST(time_integrator, imex_dimsim_has_the_published_coefficients_of_its_implicit_part) {
  // B of the L-stable method of type 2 and order 2 (Butcher, Appl. Numer. Math. 11 (1993) 347–363).
  const auto m = apsis::imex_dimsim_coefficients(2);
  const apsis::mp_real root = sqrt(apsis::mp_real(2)), rounding("1e-55");
  EXPECT_LT(abs(m.B(0, 0) - (73 - 34 * root) / 28), rounding);
  EXPECT_LT(abs(m.B(0, 1) - (4 * root - 5) / 4), rounding);
  EXPECT_LT(abs(m.B(1, 0) - (87 - 48 * root) / 28), rounding);
  EXPECT_LT(abs(m.B(1, 1) - (34 * root - 45) / 28), rounding);
}

TEST(time_integrator, a_wrong_coefficient_of_imex_dimsim_lowers_the_order) {
  using formula = apsis::multistage_formula<apsis::mp_real>;
  for (const int p : {2, 3}) {
    EXPECT_EQ(apsis::compute_multistage_orders(apsis::imex_dimsim_coefficients(p)).order, p);
    for (apsis::matrix<apsis::mp_real> formula::* part :
         {&formula::A, &formula::A_hat, &formula::B, &formula::B_hat}) {
      auto m = apsis::imex_dimsim_coefficients(p);
      (m.*part)(1, 0) += apsis::mp_real("1e-30");
      EXPECT_LT(apsis::compute_multistage_orders(m).order, p) << p;
    }
    auto m = apsis::imex_dimsim_coefficients(p);
    m.v[0] += apsis::mp_real("1e-30");
    EXPECT_EQ(apsis::compute_multistage_orders(m).order, 0) << "Σ v is not 1";
  }
}

TEST(time_integrator, a_wrong_coefficient_lowers_the_order) {
  for (const bool of_transport : {false, true}) {
    auto m = apsis::imex_bdf_coefficients<apsis::mp_real>(4);
    (of_transport ? m.c[2] : m.b) += apsis::mp_real("1e-30");
    EXPECT_EQ(apsis::compute_formula_orders(m).order, 0);
  }
}

TEST(time_integrator, errors_grow_as_the_roots_say) {
  EXPECT_EQ(apsis::error_amplification({1.0}), 1.0);
  // The history satisfies h_n − h_{n−1} = (−b)^n.
  EXPECT_NEAR(apsis::error_amplification({1.25, -0.25}), 1.0 / 0.75, 1e-14);
  EXPECT_NEAR(apsis::error_amplification({0.5, 0.5}), 1.0 / 0.5, 1e-14);
  // BDF of order 2 has the roots 1 and 1/3.
  EXPECT_NEAR(apsis::error_amplification(apsis::find_integrator("imex-bdf-2").weights), 1.5, 1e-14);
}

TEST(time_integrator, every_listed_name_is_found_and_has_consistent_data) {
  const auto names = apsis::integrator_names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const auto& name : names) {
    const auto& m = apsis::find_integrator(name);
    EXPECT_EQ(m.name, name);
    EXPECT_EQ(m.one_step() != nullptr, apsis::is_method_name(name)) << name;
    EXPECT_GE(m.starter().claims.order, m.order) << name;
    double sum = 0.0;
    for (const double weight : m.weights) sum += weight;
    EXPECT_NEAR(sum, 1.0, 1e-15) << name;
    EXPECT_EQ(m.weights.size(), static_cast<std::size_t>(m.steps)) << name;
    EXPECT_EQ(&apsis::find_integrator(name), &m) << "found again, not made again";
    EXPECT_TRUE(m.one_step() == nullptr || &m.starter() == m.one_step()) << name;
  }
  EXPECT_EQ(apsis::find_integrator("md-imex-6-3").order, 3);
  EXPECT_EQ(apsis::find_integrator("md-imex-chain-7-2").stages, 7U) << "a member of a family";
}

TEST(time_integrator, has_the_ssp_coefficient_and_the_cost_of_its_certificate) {
  for (const auto& name : {"md-imex-8-3-mixed", "ssprk-3-3", "exponential-2", "two-step-8-3-narrow",
                           "imex-bdf-1", "imex-bdf-3", "imex-dimsim-2", "imex-dimsim-3"}) {
    const auto& m = apsis::find_integrator(name);
    const auto c = m.certify();
    EXPECT_TRUE(c.claims_hold()) << name;
    const auto has = [&](const std::string& key, const apsis::integrator_certificate::value& expected) {
      const auto fact =
          std::find_if(c.facts.begin(), c.facts.end(), [&](const auto& f) { return f.key == key; });
      ASSERT_NE(fact, c.facts.end()) << name << " has no " << key;
      EXPECT_EQ(fact->is, expected) << name << " " << key;
    };
    has("order", m.order);
    has("steps", m.steps);
    has("ssp_coefficient", m.ssp_coefficient);
  }
}

TEST(time_integrator, is_of_the_kind_that_its_file_states) {
  std::set<std::string> found;
  for (const auto& file : apsis::embedded::methods()) {
    const apsis::method parsed = apsis::parse_any_method(file.text, std::string(file.name));
    const auto& m = apsis::find_integrator(std::string(file.name));
    const std::string expected = parsed.steps == 2                         ? "two-step"
                                 : to_string(parsed.kind) == "exponential" ? "exponential"
                                                                           : "runge-kutta";
    EXPECT_EQ(m.kind, expected) << file.name;
    EXPECT_EQ(m.steps, parsed.steps) << file.name;
    EXPECT_EQ(m.needs.equal_steps, parsed.steps == 2) << file.name;
    EXPECT_EQ(m.needs.exact_collision, expected == "exponential") << file.name;
    found.insert(m.kind);
  }
  found.insert({"imex-bdf", "imex-dimsim"});  // formulas without files
  std::set<std::string> kinds;
  for (const auto* kind : apsis::integrator_kind_entries()) kinds.insert(kind->name);
  EXPECT_EQ(found, kinds);
  EXPECT_EQ(apsis::integrator_names("two-step"),
            (std::vector<std::string>{"two-step-10-3-mixed", "two-step-8-3-narrow"}));
}

}  // namespace time_integrator_test
