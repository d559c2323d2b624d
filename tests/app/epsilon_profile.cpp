// `apsis check METHOD --epsilon-profile CASE`.
#include "program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace epsilon_profile_test {

using namespace app_test;
using nlohmann::json;
using testing::HasSubstr;

namespace {

const std::vector<std::string> of_small_case = {
    "check",          "md-imex-6-3",        "--epsilon-profile", "paper/bgk-mixed-fd", "space.cells=20",
    "velocity.max=9", "velocity.points=36", "time.end=0.1",      "time.dt=0.001"};

TEST(epsilon_profile, prints_predicted_errors_for_the_step_of_the_case_and_three_halvings) {
  const work_folder folder;
  const outcome text = run_apsis(folder, of_small_case);
  ASSERT_EQ(text.code, 0) << text.err;
  for (const char* said : {"SSP coefficient",
                           "predicted errors of the O(epsilon) terms of paper/bgk-mixed-fd on "
                           "point values",
                           "mass        momentum    energy", "\n  0.000125 "})
    EXPECT_THAT(text.out, HasSubstr(said));

  const json result = json::parse(run_apsis(folder, with(of_small_case, {"--json"})).out)["epsilon_profile"];
  EXPECT_NEAR(result["smallest_epsilon"].get<double>(), 1e-5, 1e-6);
  ASSERT_EQ(result["rows"].size(), 4U);
  EXPECT_GT(result["rows"][0]["largest_viscosity"].get<double>(), 2.0);
  EXPECT_GT(result["rows"][0]["error"]["mass"].get<double>(),
            result["rows"][3]["error"]["mass"].get<double>());
}

}  // namespace

}  // namespace epsilon_profile_test
