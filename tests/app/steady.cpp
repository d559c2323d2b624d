// Iterations to a steady state as a process.
#include "program.hpp"

#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steady_test {

using namespace app_test;

TEST(steady, says_in_the_log_and_in_json_how_many_values_below_0_it_removed) {
  const work_folder folder;
  bool any = false;
  for (const std::string delta : {"0.1", "1", "10", "100"}) {
    const outcome run =
        run_apsis(folder, {"run", "gas/fourier", "parameters.delta=" + delta, "boundary.left.T=9",
                           "velocity.max=18", "velocity.points=48", "model.tails=nonnegative",
                           "space.limiter=positivity", "steady.tolerance=1e-8", "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    const auto steady = nlohmann::json::parse(run.out)["steady"];
    std::smatch said;
    if (std::regex_search(run.err, said,
                          std::regex("info: (\\d+) values below 0, the smallest (\\S+), are"))) {
      EXPECT_EQ(steady["removed_values"].get<long>(), std::stol(said[1]));
      EXPECT_NEAR(steady["smallest_removed"].get<double>() / std::stod(said[2]), 1.0, 0.05);  // two digits
      any = true;
    } else {
      EXPECT_EQ(steady["removed_values"].get<long>(), 0);
    }
  }
  EXPECT_TRUE(any);
}

}  // namespace steady_test
