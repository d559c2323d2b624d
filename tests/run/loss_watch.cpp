// Warnings before and during runs about methods that are unfit for their Δt/ε.
#include "cases.hpp"
#include "laws.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/run/session.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace loss_watch_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

/// u_t + v_x = 0, v_t + u_x/3 = −v/ε with ε = 10⁻⁴ has the limit u_t = (ε/3) u_xx. Nothing else moves u.
const std::string diffusion =
    "[model]\nname = \"relaxation\"\nepsilon = 1e-4\nspeed = 0.5773502691896258\nflux = \"0*u\"\n"
    "[initial]\nu1 = \"exp(-x^2)\"\n[space]\ncells = 200\ndomain = [-5.0, 5.0]\nformulation = "
    "\"finite-difference\"\n"
    "[time]\nend = 60.0\ncfl = 0.5\n";

struct watched_run {
  std::string log;  ///< standard error
  double growth;    ///< growth of the variance of u, relative to the exact 2εt/3
  double expected;  ///< expected error
};

double variance(const apsis::simulation& run) {
  const auto table = run.fields();
  double mass = 0.0, second = 0.0;
  for (std::size_t k = 0; k < table.x.size(); ++k) {
    mass += table.values[0][k];
    second += table.values[0][k] * table.x[k] * table.x[k];
  }
  return second / mass;
}

watched_run diffuse(const std::vector<std::string>& changes) {
  testing::internal::CaptureStderr();
  apsis::simulation run(apsis::parse_case(diffusion, "diffusion", changes));
  const double before = variance(run);
  finish(run);
  const double exact = 2e-4 / 3.0 * run.t();
  return {testing::internal::GetCapturedStderr(), (variance(run) - before) / exact, run.expected_loss()};
}

}  // namespace

TEST(unfit_method, that_gets_diffusion_wrong_is_warned_about_with_the_method_that_does_not) {
  for (const char* name : {"md-imex-6-3", "md-imex-3-2", "exponential-2"}) {
    const auto run = diffuse({"time.method=" + std::string(name)});
    EXPECT_GT(std::abs(run.growth - 1.0), 0.5) << name << " " << run.growth;
    EXPECT_THAT(run.log, AllOf(HasSubstr("method '" + std::string(name) + "' is unfit for steps of "),
                               HasSubstr("choose time.method = \"md-imex-8-3-mixed\"")))
        << name;
    // The warning appears once.
    EXPECT_EQ(run.log.find("is unfit"), run.log.rfind("is unfit")) << name;
  }
  for (const char* name : {"auto", "md-imex-8-3-mixed", "md-imex-5-2", "imex-bdf-3", "imex-dimsim-3",
                           "two-step-10-3-mixed", "ars-443"}) {
    const auto run = diffuse({"time.method=" + std::string(name), "time.cfl=0.2"});
    EXPECT_NEAR(run.growth, 1.0, 0.02) << name;
    EXPECT_THAT(run.log, Not(HasSubstr("unfit"))) << name;
  }
}

TEST(unfit_method, states_how_wrong_the_diffusion_is) {
  // For ε ≪ Δt, md-imex-3-2 has flux = 0, and md-imex-6-3 has 2.7. Here Δt = 430 ε.
  EXPECT_THAT(diffuse({"time.method=md-imex-3-2"}).log, HasSubstr("are wrong by 100 %"));
  EXPECT_THAT(diffuse({"time.method=md-imex-6-3"}).log,
              testing::ContainsRegex("are wrong by 1(6[3-9]|70) %"));
}

TEST(unfit_method, resolved_by_its_steps_is_fit) {
  const auto run = diffuse({"time.method=md-imex-6-3", "model.epsilon=1.0", "time.end=2.0"});
  EXPECT_THAT(run.log, Not(HasSubstr("unfit")));
}

TEST(unfit_method, is_noticed_where_its_loss_begins_during_the_run) {
  // The gas is at rest initially, so nothing deviates from equilibrium. The source creates
  // gradients that diffuse.
  const std::string text =
      "[model]\nname = \"relaxation\"\nepsilon = 1e-3\nspeed = 0.5773502691896258\nflux = \"0*u\"\n"
      "[initial]\nu1 = 1.0\n[space]\ncells = 40\ndomain = [0.0, 1.0]\nformulation = \"finite-difference\"\n"
      "[source]\nu1 = \"0.2*max(0, min(1, t - 2))*sin(2*pi*x)\"\n[time]\nend = 20.0\ncfl = 0.5\n";
  const auto log_of = [&text](const std::string& method) {
    apsis::simulation run(apsis::parse_case(text, "source", {"time.method=" + method}));
    testing::internal::CaptureStderr();
    finish(run);
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_THAT(log_of("md-imex-6-3"), HasSubstr("method 'md-imex-6-3' is unfit for steps of "));
  EXPECT_EQ(log_of("md-imex-8-3-mixed"), "");
}

TEST(unfit_method, of_an_explicit_kind_is_unstable_and_named_so) {
  testing::internal::CaptureStderr();
  const apsis::simulation run(apsis::parse_case(diffusion, "d", {"time.method=ssprk-3-3"}));
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              AllOf(HasSubstr("method 'ssprk-3-3' is explicit and unstable in steps of "),
                    HasSubstr("choose an IMEX method such as md-imex-8-3-mixed")));
  testing::internal::CaptureStderr();
  const apsis::simulation fine(
      apsis::parse_case(diffusion, "d", {"time.method=ssprk-3-3", "model.epsilon=1"}));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(unfit_method, does_not_change_the_run_by_being_watched) {
  // The estimate leaves no trace, for fit and unfit methods. A restart, which estimates anew, has the same
  // bits (restart.cpp). So has a run whose first step precedes any estimate.
  apsis::case_config c = apsis::parse_case(diffusion, "d", {"time.method=md-imex-6-3", "time.end=3.0"});
  testing::internal::CaptureStderr();
  apsis::simulation once(c), parts(c);
  finish(once);
  parts.advance();
  const auto saved = parts.save();
  apsis::simulation later(c);
  later.restore(saved);
  finish(later);
  testing::internal::GetCapturedStderr();
  EXPECT_EQ(once.state(), later.state());
}

TEST(automatic_method, is_the_first_line_of_the_log_with_its_reason) {
  testing::internal::CaptureStderr();
  const apsis::run_session session(apsis::parse_case(diffusion, "diffusion", {"time.end=0.1"}), {});
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_THAT(
      log.substr(0, log.find('\n')),
      AllOf(HasSubstr("diffusion: time.method = \"auto\" is md-imex-8-3-mixed (equal steps on a mesh, "),
            HasSubstr("C dt/epsilon = ")));
  testing::internal::CaptureStderr();
  const apsis::run_session named(
      apsis::parse_case(diffusion, "diffusion", {"time.end=0.1", "time.method=md-imex-5-2"}), {});
  EXPECT_THAT(testing::internal::GetCapturedStderr(), Not(HasSubstr("auto")));
}

TEST(automatic_method, runs_every_built_in_case) {
  for (const auto& name : apsis::case_names()) {
    apsis::case_config c = apsis::load_case(name, {"time.method=auto"});
    if (c.prescribed.given_elsewhere() || c.space.cells.size() > 1) continue;  // several dimensions are slow
    testing::internal::CaptureStderr();
    apsis::simulation run(c);
    run.advance();
    testing::internal::GetCapturedStderr();
    EXPECT_EQ(run.step(), 1) << name;
  }
}

TEST(automatic_method, of_a_case_that_was_never_resolved_is_chosen_by_the_run) {
  apsis::case_config c = small("auto", "finite-difference");
  const apsis::simulation run(c);
  EXPECT_EQ(run.config().time.method, "md-imex-8-3-mixed");
}

}  // namespace loss_watch_test
