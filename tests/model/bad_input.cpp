// Formulas of the tables in the folder bad_input are refused.
#include <support/bad_input.hpp>

#include <apsis/model/expression.hpp>

#include <gtest/gtest.h>

namespace bad_input_test {

TEST(bad_input, is_refused_at_its_place_with_its_reason) {
  bad_input::expect_answers(bad_input::rows_in(APSIS_BAD_INPUT), [](const bad_input::row& r) {
    return bad_input::answer_of(
        [&] { static_cast<void>(apsis::expression(r.text, {"c.toml", 3, 12}).evaluate(0.5)); });
  });
}

}  // namespace bad_input_test
