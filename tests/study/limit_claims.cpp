// Claims about limits ε → 0.
#include <study/claim_checks.hpp>

TEST(claims, C16_broadwell_in_moment_form_its_limit_system_and_its_equilibrium) {
  expect_claim("C16");
}

TEST(claims, C17_becomes_the_explicit_method_on_the_limit_system_for_all_models_from_any_data) {
  expect_claim("C17");
}
