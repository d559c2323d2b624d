// Nonnegativity on velocity grids much wider than the support of f. In the tails f passes through subnormal
// numbers, below 2.2e-308, where rounding errors are absolute.
#include "cases.hpp"

#include <apsis/method/method.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>
#include <support/catalogue.hpp>

namespace positivity_test {

namespace {

/// Returns true if the method has r > 0, so that it can run with steps r Δt_FE.
bool is_convex(const apsis::method& m) {
  const auto claimed = m.claims.ssp_coefficient.value_or("0");
  return m.kind != apsis::method_kind::implicit_only && claimed != "0";
}

apsis::case_config wide(const std::string& method, const std::string& how, double max, int points) {
  auto c = mixed("mixed-v", method, how);
  c.space.cells = {20};
  c.velocity = {max, points, apsis::equilibrium_choice::automatic};
  c.time.cfl.reset();
  c.time.safety = 1.0;
  return c;
}

/// Returns the number of subnormal values of a state.
long subnormal_values(const std::vector<double>& state) {
  return std::count_if(state.begin(), state.end(),
                       [](double f) { return std::fpclassify(f) == FP_SUBNORMAL; });
}

class wide_grids : public testing::TestWithParam<std::tuple<std::string, double>> {};

}  // namespace

TEST(shipped_gases, promise_positivity_where_their_model_keeps_f_nonnegative) {
  int promising = 0;
  for (const auto& name : apsis::case_names()) {
    if (!name.starts_with("gas/")) continue;
    apsis::case_config c = apsis::load_case(name);
    const int most = enough_cells(c, c.space.cells.size() < 3 ? 24 : 6);
    if (c.solids.empty())  // promises do not depend on the mesh
      for (int& cells : c.space.cells) cells = std::min(cells, most);
    const apsis::simulation run(c);
    EXPECT_EQ(run.promises().positivity, run.promises().why_signed.empty()) << name;
    promising += run.promises().positivity ? 1 : 0;
  }
  EXPECT_GE(promising, 20);
}

TEST_P(wide_grids, keep_f_nonnegative_with_every_method_at_the_largest_step) {
  const auto [how, max] = GetParam();
  long subnormal = 0, runs = 0;
  for (const auto& method : methods_where(is_convex)) {
    // The spacing is at most 1.8. The coldest gas has the thermal speed 0.91.
    auto c = wide(method, how, max, max < 100.0 ? 300 : 1112);
    apsis::simulation run(c);
    ASSERT_TRUE(run.promises().positivity) << method;
    for (int step = 0; step < 40 && !run.finished(); ++step) {
      run.advance();
      subnormal += subnormal_values(run.state());
    }
    EXPECT_EQ(run.summary().negative_values, 0) << method;
    EXPECT_LE(run.summary().conservation_defect, 1e-12) << method;
    ++runs;
  }
  EXPECT_GE(runs, 20);
  EXPECT_GT(subnormal, 0) << "no value was subnormal: the test is vacuous";
}

INSTANTIATE_TEST_SUITE_P(widths, wide_grids,
                         testing::Combine(testing::Values(std::string("finite-volume"),
                                                          std::string("finite-difference")),
                                          testing::Values(52.0, 60.0, 66.0, 1000.0)),
                         [](const auto& parameters) {
                           const auto how = std::get<0>(parameters.param);
                           return std::string(how == "finite-volume" ? "averages_" : "points_") +
                                  std::to_string(static_cast<int>(std::get<1>(parameters.param)));
                         });

}  // namespace positivity_test
