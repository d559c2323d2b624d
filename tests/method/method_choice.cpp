// The table of choices answers every request with a method that satisfies the request.
#include <apsis/method/method_choice.hpp>

#include <apsis/method/certificate.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/rate_errors.hpp>

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace method_choice_test {

namespace {

const double inf = std::numeric_limits<double>::infinity();

std::vector<apsis::method_request> all_requests() {
  std::vector<apsis::method_request> all;
  for (const auto& [space, general] :
       {std::pair(false, false), std::pair(false, true), std::pair(true, false)})
    for (const bool signs : {false, true})
      for (const bool graded : {false, true})
        for (const std::optional<double> tolerance :
             {std::optional<double>(), std::optional(1e-2), std::optional(1e-5), std::optional(1e-13)})
          for (const std::optional<double> ratio :
               {std::optional<double>(), std::optional(1e-3), std::optional(0.5), std::optional(30.0),
                std::optional(inf)})
            for (const bool longest : {false, true})
              all.push_back({space, general, signs, graded, longest, tolerance, ratio, ratio});
  return all;
}

}  // namespace

TEST(choice, is_a_method_that_can_do_what_is_asked) {
  for (const auto& wanted : all_requests()) {
    const auto chosen = apsis::choose_method(wanted);
    const apsis::method& m = apsis::find_method(chosen.method);
    EXPECT_FALSE(chosen.reason.empty());
    if (wanted.signs || (wanted.space && wanted.longest_steps && !wanted.tolerance)) {
      EXPECT_GT(static_cast<double>(apsis::certify(m).ssp_coefficient), 0.0) << m.name;
    }
    if (wanted.tolerance) {
      EXPECT_TRUE(m.embedded.has_value()) << m.name;
    }
    if (m.kind == apsis::method_kind::explicit_only) {
      EXPECT_TRUE(wanted.highest_ratio && *wanted.highest_ratio <= apsis::resolved_ratio) << m.name;
      EXPECT_FALSE(wanted.graded_start);
      // The method is stable even if the rate doubles.
      EXPECT_LT(apsis::rate_errors_at(m, 2.0 * apsis::resolved_ratio).flux, inf);
    } else {
      EXPECT_EQ(m.kind, apsis::method_kind::imex);
      const auto response = apsis::compute_rate_response(m);
      ASSERT_TRUE(response);
      // The terms of size ε are right in the limit, so no choice has a plateau.
      EXPECT_NEAR(apsis::rate_errors_at(m, 1e8).flux, 0.0, 1e-5) << m.name;
    }
  }
}

TEST(choice, depends_on_bounds_tolerance_and_kind_of_problem) {
  const auto name = [](const apsis::method_request& wanted) { return apsis::choose_method(wanted).method; };
  EXPECT_EQ(name({.space = true, .signs = true}), "md-imex-8-3-mixed");
  EXPECT_EQ(name({.space = true, .signs = true, .longest_steps = true}), "md-imex-10-3-long");
  EXPECT_EQ(name({.space = true, .longest_steps = true}), "md-imex-10-3-long");
  EXPECT_EQ(name({.space = true, .signs = true, .tolerance = 1e-4}), "md-imex-10-3-mixed");
  EXPECT_EQ(name({.space = true, .tolerance = 1e-3}), "extrapolated-euler-3");
  EXPECT_EQ(name({.space = true, .tolerance = 1e-6}), "extrapolated-euler-4");
  EXPECT_EQ(name({.general = true, .tolerance = 1e-3}), "ark-548-2");
  EXPECT_EQ(name({.general = true, .tolerance = 1e-9}), "ark-548-2");
  EXPECT_EQ(name({.general = true, .signs = true, .tolerance = 1e-4}), "md-imex-10-3-mixed");
  EXPECT_EQ(name({.general = true}), "extrapolated-euler-8");
  EXPECT_EQ(name({.lowest_ratio = 0.01, .highest_ratio = 0.01}), "dop853");
  EXPECT_EQ(name({.lowest_ratio = 0.01, .highest_ratio = 100.0}), "extrapolated-euler-8");
  EXPECT_EQ(name({.lowest_ratio = {}, .highest_ratio = {}}), "extrapolated-euler-8");
  EXPECT_THAT(apsis::choose_method({.space = true, .lowest_ratio = 0.02, .highest_ratio = 30.0}).reason,
              testing::StartsWith("equal steps on a mesh, C dt/epsilon = 0.02 to 30: "));
}

}  // namespace method_choice_test
