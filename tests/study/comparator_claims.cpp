// Claims that compare with methods of others.
#include <study/claim_checks.hpp>

TEST(claims, C9_r_is_23_percent_larger_than_that_of_the_second_order_method_of_hu_shu_zhang) {
  expect_claim("C9");
}
