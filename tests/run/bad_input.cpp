// The cases of the tables in the folder bad_input are refused before their first step.
#include <support/bad_input.hpp>

#include <apsis/run/simulation.hpp>

#include <gtest/gtest.h>

namespace bad_input_test {

TEST(bad_input, is_refused_at_its_place_with_its_reason) {
  bad_input::expect_answers(
      bad_input::rows_in(APSIS_BAD_INPUT, apsis::read_case), [](const bad_input::row& r) {
        return bad_input::answer_of(
            [&] { const apsis::simulation run(apsis::parse_case(r.text, "c.toml", r.set)); });
      });
}

}  // namespace bad_input_test
