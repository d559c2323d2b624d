// The default limiter is on where it keeps f ≥ 0 without shorter steps.
#include <apsis/config/limiter_of_case.hpp>

#include <apsis/config/case.hpp>

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace limiter_of_case_test {

using apsis::limiter_choice;

namespace {

limiter_choice limiter_of(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return apsis::load_case(name, overrides).space.limiter;
}

}  // namespace

TEST(default_limiter, keeps_f_nonnegative_where_it_costs_no_step) {
  for (const char* flow :
       {"gas/cavity", "gas/couette", "gas/poiseuille", "gas/shock", "gas/step", "gas/duct"})
    EXPECT_EQ(limiter_of(flow), limiter_choice::positivity) << flow;
  EXPECT_EQ(limiter_of("gas/couette", {"space.formulation=finite-volume", "space.collisions=centres"}),
            limiter_choice::positivity);
  EXPECT_EQ(limiter_of("gas/couette", {"time.method=auto"}), limiter_choice::positivity);
}

TEST(default_limiter, keeps_f_nonnegative_in_every_shipped_gas_whose_model_does) {
  int kept = 0, without = 0;
  for (const auto& name : apsis::case_names()) {
    if (!name.starts_with("gas/")) continue;
    const auto config = apsis::load_case(name);
    const bool nonnegative = apsis::make_model(config)->why_signed().empty();
    EXPECT_EQ(config.space.limiter, nonnegative ? limiter_choice::positivity : limiter_choice::none) << name;
    (nonnegative ? kept : without) += 1;
  }
  EXPECT_GE(kept, 20);
  EXPECT_EQ(without, 1);  // gas/fourier: the published target of Shakhov is signed
}

TEST(default_limiter, is_none_where_it_would_make_steps_shorter) {
  EXPECT_EQ(limiter_of("gas/couette", {"space.formulation=finite-volume"}), limiter_choice::none);
  EXPECT_EQ(limiter_of("gas/couette", {"space.formulation=finite-volume", "space.collisions=gauss"}),
            limiter_choice::none);
}

TEST(default_limiter, is_none_where_nothing_is_to_be_kept_or_it_cannot_be_kept) {
  EXPECT_EQ(limiter_of("gas/couette", {"space.reconstruction=upwind1"}), limiter_choice::none);
  EXPECT_EQ(limiter_of("gas/couette", {"time.method=ars-443"}), limiter_choice::none);  // SSP coefficient 0
  EXPECT_EQ(limiter_of("gas/couette", {"model.name=shakhov"}), limiter_choice::none);  // the target is signed
  EXPECT_EQ(limiter_of("gas/couette", {"model.name=shakhov", "model.tails=nonnegative"}),
            limiter_choice::positivity);
  EXPECT_EQ(limiter_of("laws/euler-sod"), limiter_choice::none);  // momentum has both signs
  EXPECT_EQ(limiter_of("paper/ode"), limiter_choice::none);       // the model has no space
}

TEST(default_limiter, gives_way_to_the_case) {
  EXPECT_EQ(limiter_of("gas/couette", {"space.limiter=none"}), limiter_choice::none);
  EXPECT_EQ(limiter_of("gas/couette", {"space.formulation=finite-volume", "space.limiter=positivity"}),
            limiter_choice::positivity);
  EXPECT_EQ(limiter_of("paper/bgk-accuracy"), limiter_choice::none);
}

TEST(default_limiter, of_a_file_that_is_no_method_is_left_to_the_run) {
  apsis::case_config config = apsis::load_case("gas/couette");
  config.time.method = "missing.toml";
  EXPECT_EQ(apsis::default_limiter(config), limiter_choice::none);
}

}  // namespace limiter_of_case_test
