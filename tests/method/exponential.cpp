// Exponential methods as data: conditions of second order by a formula, refusals, and the step of a form.
#include <apsis/core/errors.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/order_conditions.hpp>
#include <apsis/method/polish.hpp>
#include <apsis/method/resolved_flows.hpp>

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace exponential_method_test {

namespace {

using apsis::certify;
using apsis::parse_method;
using testing::HasSubstr;

/// Returns the file of f₀ = exp(a₀ΔtQ) u^n, f₁ = exp(a₁ΔtQ)(f₀ + Δt/r T(f₀)), u^{n+1} = exp(a₂ΔtQ)(w (f₁ +
/// Δt/r T(f₁)) + (1 − w) exp(a₁ΔtQ) f₀). The coefficients are texts.
std::string file(const std::string& a0, const std::string& a1, const std::string& a2, const std::string& w,
                 const std::string& rest, const std::string& r) {
  return fmt::format(
      "name = \"trial\"\ntitle = \"trial\"\ncitation = \"none\"\nkind = \"exponential\"\n[claims]\norder = "
      "2\n[shu_osher]\nr = \"{}\"\nP = [[], [\"0\"], [\"1\", \"0\"], [\"0\", \"0\", \"{}\"]]\nW = [[], "
      "[\"1\"], [\"0\", \"0\"], [\"0\", \"{}\", \"0\"]]\nd = [\"{}\", \"{}\", \"{}\", \"{}\"]\n",
      r, rest, w, a0, a1, a1, a2);
}

}  // namespace

TEST(exponential_method, of_the_catalogue_has_second_order_and_the_step_of_forward_euler) {
  const auto& c = apsis::find_certificate("exponential-2");
  EXPECT_TRUE(c.claims_hold);
  EXPECT_EQ(c.order, 2);
  EXPECT_TRUE(c.unconditional);
  EXPECT_TRUE(c.bounded);
  EXPECT_EQ(c.ssp_coefficient, 1);
  EXPECT_EQ(c.explicit_evaluations, 2);
  EXPECT_EQ(c.implicit_solves, 4);
  EXPECT_EQ(c.ap_data, "any data");
}

// With equal Euler steps of length 1/r the conditions of second order are 2w/r = 1, w/r² = 1/2, a₀ + a₁ + a₂
// = 1 and a₀ + (w/r) a₁ = 1/2. Their solution is r = 1, w = 1/2 with a₀ = a₂ free.
TEST(exponential_method, of_second_order_satisfies_four_conditions) {
  for (const auto& [a0, a1] :
       {std::pair{"0", "1"}, std::pair{"1/10", "4/5"}, std::pair{"2/5", "1/5"}, std::pair{"1/2", "0"}})
    EXPECT_EQ(certify(parse_method(file(a0, a1, a0, "1/2", "1/2", "1"), "trial.toml")).order, 2) << a0;
}

TEST(exponential_method, that_violates_one_condition_has_first_order_and_a_message) {
  const auto failures = [](const std::string& text) {
    const auto c = certify(parse_method(text, "trial.toml"));
    EXPECT_EQ(c.order, 1);
    EXPECT_FALSE(c.claims_hold);
    return c.failures;
  };
  // The collisions precede ∫ T. The conditions b·c that mix transport and collision, F[G] and G[F], are then
  // violated. G[G] and F[F] hold.
  EXPECT_THAT(failures(file("1/4", "1/4", "1/2", "1/2", "1/2", "1")),
              testing::ElementsAre(HasSubstr("tree F[G] is 0.375 instead of 0.5"),
                                   HasSubstr("tree G[F] is 0.625 instead of 0.5")));
  // The first file has 2w/r = 2/3, the second a₀ + a₁ + a₂ = 5/6. Both must be 1 for order 1.
  EXPECT_EQ(certify(parse_method(file("1/3", "1/3", "1/3", "1/3", "2/3", "1"), "trial.toml")).order, 0);
  EXPECT_EQ(certify(parse_method(file("1/3", "1/3", "1/6", "1/2", "1/2", "1"), "trial.toml")).order, 0);
}

// exp(ΔtQ/2) (u + Δt T) exp(ΔtQ/2) with T = 0 is exact. All trees of Q alone hold up to the order
// of the flow.
TEST(exponential_method, resolved_flows_satisfy_all_conditions_of_the_collision_alone) {
  auto m =
      parse_method(file("1/8", "3/8", "1/2", "1/2", "1/2", "1"), "trial.toml").coefficients<apsis::mp_real>();
  const auto b = apsis::to_butcher(apsis::with_resolved_flows(m));
  EXPECT_EQ(b.stages(), 20U);
  const auto trees = apsis::rooted_trees(apsis::order_of_resolved_flows, apsis::tree_colours::G_only);
  const auto weights = apsis::elementary_weights(b, trees);
  // The path through either of the two middle stages has all of Q, because both have the same times.
  for (std::size_t k = 0; k < trees.size(); ++k)
    EXPECT_LT(abs(weights[k] - apsis::mp_real(1) / trees[k].density), 1e-50) << trees[k].name;
}

TEST(exponential_method, step_is_that_of_the_shortest_euler_step_of_the_form) {
  auto m = apsis::find_method("exponential-2").coefficients<double>();
  EXPECT_EQ(apsis::largest_step_of_form(m), 1.0);
  m.P(3, 1) = 0.25;  // u_1 + Δt T(u_1) of half the weight: with a quarter more of u_1, half as far again
  EXPECT_EQ(apsis::largest_step_of_form(m), 1.0);
  m.P(1, 0) = 1.0;
  EXPECT_EQ(apsis::largest_step_of_form(m), 1.5);
  EXPECT_EQ(certify(parse_method(file("1/3", "1/3", "1/3", "-1/2", "3/2", "1"), "x.toml")).ssp_coefficient,
            0);
}

TEST(exponential_method, is_read_and_has_no_form_to_polish) {
  EXPECT_NO_THROW(parse_method(file("1/3", "1/3", "1/3", "1/2", "1/2", "1"), "trial.toml"));
  EXPECT_THROW(apsis::polish(apsis::find_method("exponential-2")), apsis::input_error);
}

TEST(exponential_method, is_the_same_after_export) {
  const auto& m = apsis::find_method("exponential-2");
  const auto again = parse_method(apsis::to_toml(m), "exported.toml");
  EXPECT_EQ(apsis::to_toml(again), apsis::to_toml(m));
  EXPECT_EQ(again.kind, apsis::method_kind::exact_collision);
  EXPECT_THAT(apsis::to_latex(m), testing::Not(HasSubstr("\\dot d")));
}

}  // namespace exponential_method_test
