// Claims about the ODE model.
#include <study/claim_checks.hpp>

TEST(claims, C19_orders_2_and_3_at_both_ends_and_plateaus_proportional_to_epsilon_between) {
  expect_claim("C19");
}
TEST(claims, C20_on_the_plateau_the_methods_still_converge_at_design_order) {
  expect_claim("C20");
}
TEST(claims, C21_round_off_stops_third_order_as_printed_and_is_removed) {
  expect_claim("C21");
}
