// Methods of the C interface: the catalogue, coefficients, certificates and method files.
#include <apsis/method/certificate.hpp>
#include <apsis/method/export.hpp>
#include <apsis/method/tableau.hpp>
#include <apsis/method/time_integrator.hpp>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <c/ode.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/folder.hpp>

namespace c_methods_test {

namespace {

using namespace c_interface;

std::vector<double> coefficients(const method& m, int which, std::size_t count) {
  std::vector<double> values(count, std::nan(""));
  EXPECT_EQ(apsis_method_coefficients(m.get(), which, values.data()), APSIS_OK) << apsis_error_message();
  return values;
}

double fact(const method& m, const char* key) {
  double value = std::nan("");
  EXPECT_EQ(apsis_method_fact(m.get(), key, &value), APSIS_OK) << apsis_error_message();
  return value;
}

void ask_for(const char* name) {
  apsis_method* none = nullptr;
  const int status = apsis_find_method(name, &none);
  EXPECT_EQ(none, nullptr);
  rethrow(status);
}

}  // namespace

TEST(c_methods, are_those_of_the_catalogue) {
  const auto names = apsis::integrator_names();
  ASSERT_EQ(apsis_catalogue_size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(apsis_catalogue_name(i), names[i]);
  EXPECT_EQ(apsis_catalogue_name(names.size()), nullptr);
}

TEST(c_methods, have_the_properties_of_their_integrators) {
  for (const std::string name : {"md-imex-6-3", "dop853", "exponential-2", "imex-bdf-4", "imex-dimsim-3",
                                 "two-step-8-3-narrow", "md-imex-chain-5-2"}) {
    const auto& expected = apsis::find_integrator(name);
    const auto m = find(name.c_str());
    EXPECT_EQ(apsis_method_name(m.get()), name);
    EXPECT_EQ(apsis_method_title(m.get()), expected.title);
    EXPECT_EQ(apsis_method_kind(m.get()), expected.kind);
    EXPECT_EQ(apsis_method_order(m.get()), expected.order);
    EXPECT_EQ(apsis_method_steps(m.get()), expected.steps);
    EXPECT_EQ(apsis_method_stages(m.get()), expected.stages);
    EXPECT_EQ(apsis_method_ssp_coefficient(m.get()), expected.ssp_coefficient);
    EXPECT_EQ((apsis_method_needs(m.get()) & APSIS_NEEDS_RATE) != 0, expected.needs.explicit_collision);
    EXPECT_EQ((apsis_method_needs(m.get()) & APSIS_NEEDS_FLOW) != 0, expected.needs.exact_collision);
    EXPECT_EQ((apsis_method_needs(m.get()) & APSIS_NEEDS_EQUAL_STEPS) != 0, expected.needs.equal_steps);
  }
}

TEST(c_methods, have_coefficients_in_both_forms) {
  const auto m = find("md-imex-6-3");
  const std::size_t s = apsis_method_stages(m.get());
  const auto form = apsis::find_method("md-imex-6-3").coefficients<double>();
  EXPECT_EQ(coefficients(m, APSIS_SHU_OSHER_DDOT, s), form.ddot);
  EXPECT_EQ(coefficients(m, APSIS_SHU_OSHER_R, 1), std::vector<double>{form.r});
  const auto p = coefficients(m, APSIS_SHU_OSHER_P, s * s), w = coefficients(m, APSIS_SHU_OSHER_W, s * s),
             d = coefficients(m, APSIS_SHU_OSHER_D, s * s);
  // The Butcher form satisfies R Â = W/r, R A = D and R Ȧ = diag(ḋ) with R = I − P − W, up
  // to rounding errors.
  const auto explicit_part = coefficients(m, APSIS_BUTCHER_A_HAT, s * s),
             implicit_part = coefficients(m, APSIS_BUTCHER_A, s * s),
             derivative = coefficients(m, APSIS_BUTCHER_A_DOT, s * s);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < s; ++j) {
      double of_hat = 0, of_a = 0, of_dot = 0;
      for (std::size_t k = 0; k < s; ++k) {
        const double r = (i == k ? 1.0 : 0.0) - p[i * s + k] - w[i * s + k];
        of_hat += r * explicit_part[k * s + j];
        of_a += r * implicit_part[k * s + j];
        of_dot += r * derivative[k * s + j];
      }
      EXPECT_NEAR(of_hat, w[i * s + j] / form.r, 1e-14);
      EXPECT_NEAR(of_a, d[i * s + j], 1e-14);
      EXPECT_NEAR(of_dot, i == j ? form.ddot[i] : 0.0, 1e-14);
    }
}

TEST(c_methods, have_the_facts_of_their_certificates) {
  const auto m = find("md-imex-6-3");
  const auto& c = apsis::find_certificate("md-imex-6-3");
  EXPECT_EQ(fact(m, "order"), c.order);
  EXPECT_EQ(fact(m, "ssp_coefficient"), c.ssp_coefficient.convert_to<double>());
  EXPECT_EQ(fact(m, "gsa"), c.gsa ? 1 : 0);
  EXPECT_EQ(fact(m, "stability.angle_degrees"), c.stability.angle);
  const char* text = nullptr;
  ASSERT_EQ(apsis_method_certificate(m.get(), &text), APSIS_OK);
  EXPECT_THAT(text, testing::AllOf(testing::HasSubstr("\norder = 3\n"), testing::HasSubstr("\ntype = A\n"),
                                   testing::HasSubstr("\nclaims_hold = true\n")));
  for (const char* name : {"exponential-2", "imex-bdf-3", "imex-dimsim-2", "two-step-8-3-narrow"})
    EXPECT_EQ(fact(find(name), "order"), apsis::find_integrator(name).order) << name;
}

TEST(c_methods, are_read_from_files_that_the_interface_writes) {
  const test_folder folder;
  const auto of_catalogue = find("md-imex-6-3");
  const char* text = nullptr;
  ASSERT_EQ(apsis_method_file(of_catalogue.get(), &text), APSIS_OK);
  EXPECT_EQ(text, apsis::to_toml(apsis::find_method("md-imex-6-3")));
  const std::string path = folder / "own.toml";
  std::ofstream(path) << text;
  const auto m = find(path.c_str());
  EXPECT_STREQ(apsis_method_name(m.get()), "md-imex-6-3");
  EXPECT_EQ(coefficients(m, APSIS_SHU_OSHER_DDOT, 6), coefficients(of_catalogue, APSIS_SHU_OSHER_DDOT, 6));
  EXPECT_EQ(fact(m, "order"), 3);

  // The method has order 3, so a claim of order 4 does not hold.
  std::string wrong = text;
  wrong.replace(wrong.find("order = 3"), 9, "order = 4");
  std::ofstream(path) << wrong;
  apsis_method* none = nullptr;
  EXPECT_EQ(apsis_find_method(path.c_str(), &none), APSIS_CLAIM_ERROR);
  EXPECT_THAT(apsis_error_message(), testing::HasSubstr("order"));
  EXPECT_EQ(none, nullptr);
}

TEST(c_methods, refuse_what_they_do_not_have) {
  const auto bdf = find("imex-bdf-3"), two = find("two-step-8-3-narrow"), m = find("md-imex-6-3");
  double value = 0;
  const char* text = nullptr;
  bad_input::expect_refused({
      {[] { ask_for("md-imex-6-4"); }, {"unknown method 'md-imex-6-4'", "did you mean 'md-imex-6-3'?"}},
      {[] { ask_for("there/is/no-such.toml"); }, {"there/is/no-such.toml"}},
      {[] { ask_for(nullptr); }, {"the name of the method is NULL"}},
      {[] { rethrow(apsis_find_method("md-imex-6-3", nullptr)); }, {"the place of the method is NULL"}},
      {[&] { rethrow(apsis_method_fact(m.get(), "ordr", &value)); },
       {"the certificate of 'md-imex-6-3' has no key 'ordr'", "did you mean 'order'?"}},
      {[&] { rethrow(apsis_method_fact(m.get(), "type", &value)); }, {"has no number 'type'"}},
      {[&] { rethrow(apsis_method_coefficients(bdf.get(), APSIS_SHU_OSHER_P, &value)); },
       {"'imex-bdf-3' has no coefficients of stages (it is a formula)"}},
      {[&] { rethrow(apsis_method_coefficients(two.get(), APSIS_BUTCHER_A, &value)); },
       {"'two-step-8-3-narrow' has no Butcher form (it takes 2 steps)"}},
      {[&] { rethrow(apsis_method_coefficients(m.get(), 8, &value)); }, {"unknown coefficients 8", "0 to 7"}},
      {[&] { rethrow(apsis_method_coefficients(nullptr, 0, &value)); }, {"the method is NULL"}},
      {[&] { rethrow(apsis_method_file(bdf.get(), &text)); }, {"it is a formula"}},
  });
  EXPECT_EQ(apsis_method_order(nullptr), 0);
  EXPECT_STREQ(apsis_method_name(nullptr), "");
  apsis_free_method(nullptr);
}

}  // namespace c_methods_test
