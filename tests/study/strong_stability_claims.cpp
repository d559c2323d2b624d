// Claims about what steps keep: positivity, norms, entropy.
#include <study/claim_checks.hpp>

TEST(claims, C10_implicit_methods_keep_square_decay_positive_for_every_step) {
  expect_claim("C10");
}
TEST(claims, C11_dirk_methods_lose_positivity_beyond_1_50_and_1_75) {
  expect_claim("C11");
}
TEST(claims, C12_monotone_decay_holds_for_the_ssp_methods_and_fails_for_dirk) {
  expect_claim("C12");
}
TEST(claims, C13_implicit_methods_reach_their_orders_on_square_decay) {
  expect_claim("C13");
}
