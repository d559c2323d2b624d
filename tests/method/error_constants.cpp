// Error constants agree with independently computed values.
#include "tableaux.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace apsis::test::error_constants_test {
namespace {

TEST(error_constant, equals_the_value_of_the_programs_that_found_the_methods) {
  const std::map<std::string, double> printed = {{"md-imex-7-3-large-r", 0.9734472790908525},
                                                 {"md-imex-8-3-large-r", 1.120423907321536},
                                                 {"md-imex-14-4-large-r", 4.420585429058345},
                                                 {"imdrk-3-3", 0.009837084680136589},
                                                 {"imdrk-9-5", 0.00797602388456816}};
  for (const auto& [name, value] : printed)
    // Those programs compute in double precision.
    EXPECT_NEAR(find_certificate(name).error_constant.convert_to<double>(), value, 1e-12 * (1 + value))
        << name;
}

TEST(error_constant, of_small_methods_equals_the_value_derived_by_hand) {
  // For u' = u + Δt Q(u') − ½ Δt² Q̇(u') with c = 1, G[G,G] is 1 − 1 = 0 instead of 1/3, and G[G[G]] is ½ − ½
  // = 0 instead of 1/6.
  EXPECT_NEAR(find_certificate("imdrk-1-2").error_constant.convert_to<double>(), std::sqrt(5.0) / 6, 1e-15);
  // For SSPRK(2,2), F[F,F] is ½ instead of 1/3, and F[F[F]] is 0 instead of 1/6.
  EXPECT_NEAR(find_certificate("ssprk-2-2").error_constant.convert_to<double>(), std::sqrt(2.0) / 6, 1e-15);
  // SSPRK(3,3) has b = (1/6, 1/6, 2/3) and c = (0, 1, ½). The conditions of order 4 have the right-hand sides
  // F[F,F,F] ¼, F[F,F[F]] ⅛, F[F[F,F]] 1/12, F[F[F[F]]] 1/24.
  const double bush = 1.0 / 6 + 2.0 / 3 / 8 - 0.25, fork = 2.0 / 3 / 2 / 4 - 0.125,
               broom = 2.0 / 3 / 4 - 1.0 / 12;
  EXPECT_NEAR(find_certificate("ssprk-3-3").error_constant.convert_to<double>(),
              std::hypot(std::hypot(bush, fork), std::hypot(broom, 1.0 / 24)), 1e-15);
}

TEST(error_constant, of_the_papers_methods_is_as_documented) {
  EXPECT_NEAR(find_certificate("md-imex-3-2").error_constant.convert_to<double>(), 0.466, 5e-4);
  EXPECT_NEAR(find_certificate("md-imex-6-3").error_constant.convert_to<double>(), 4.3, 0.05);
  EXPECT_NEAR(find_certificate("imdrk-2-3").error_constant.convert_to<double>(), 0.281, 5e-4);
  EXPECT_NEAR(find_certificate("imdrk-5-4").error_constant.convert_to<double>(), 0.087, 5e-4);
}

TEST(error_constant, is_positive_for_every_method) {
  for (const auto& name : method_names()) EXPECT_GT(find_certificate(name).error_constant, 1e-5) << name;
}

}  // namespace
}  // namespace apsis::test::error_constants_test
