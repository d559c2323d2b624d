// Runs with methods of several equal steps: the results of integrate(), observed orders, restarts,
// conservation between walls, changes of the step and promises.
#include "gas_between_walls.hpp"
#include "same_results.hpp"

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/integrate/any_stepper.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/run/session.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/folder.hpp>

namespace equal_steps_test {

namespace {

using namespace apsis;
using between_walls::distance, between_walls::end_of;
using testing::HasSubstr;

case_config gas(const std::string& method, const std::string& time, const std::string& more = "") {
  return between_walls::case_of({.method = method, .time = time, .more = more});
}

/// Relaxation of one cell with ε = 0.3. All errors are errors in time.
case_config decay(const std::string& method, long steps) {
  return load_case("paper/ode", {"model.epsilon=0.3", "time.method=" + method, "time.end=1",
                                 fmt::format("time.dt={:.17g}", 1.0 / static_cast<double>(steps))});
}

}  // namespace

TEST(equal_steps, has_the_bits_of_integrate) {
  for (const auto& name : names_of_several_steps()) {
    for (const std::string start : {"", "startup = \"graded\"\n"}) {
      const case_config c = gas(name, "dt = 0.002\nend = 0.04\n" + start);
      const run_setup setup(c);
      const auto problem = setup.make_problem();
      field u = setup.initial_state();
      auto rule = step_rule<double>::fixed(0.002);
      if (!start.empty()) rule.start = startup::graded;
      with_stepper(find_integrator(name), *problem,
                   [&](auto march) { integrate(march, u, 0.0, 0.04, rule); });
      const std::vector<double> found = end_of(c);
      std::size_t different = 0;
      auto next = found.begin();
      for (int cell = 0; cell < u.cells(); ++cell)
        for (int k = 0; k < u.components(); ++k) different += *next++ == u.row(cell)[k] ? 0 : 1;
      EXPECT_EQ(different, 0U) << name << " " << start;
    }
  }
}

TEST(equal_steps, observed_order_is_the_claimed_one) {
  // Its error is below 1e-14.
  const auto exact = end_of(decay("ark-548-2", 2048));
  for (const auto& name : names_of_several_steps()) {
    const int order = find_integrator(name).order;
    // The steps are so long that errors stay above rounding, and so short that the first term dominates.
    // The error of general linear methods changes its sign near 300 steps.
    const long steps = find_integrator(name).kind == "imex-dimsim" ? 2560 : order <= 3 ? 640 : 160;
    const double coarse = distance(end_of(decay(name, steps)), exact),
                 fine = distance(end_of(decay(name, 2 * steps)), exact);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.3) << name;
  }
}

TEST(equal_steps, continues_bit_for_bit_from_every_step) {
  const test_folder folder;
  for (const std::string name :
       {"imex-bdf-1", "imex-bdf-3", "imex-bdf-4", "imex-dimsim-3", "two-step-10-3-mixed"}) {
    const case_config c =
        gas(name, "dt = 0.002\nend = 0.02\nstartup = \"graded\"\n", "[output]\nevery = 0.01\n");
    const auto run = [&](const std::string& out, long steps, const std::string& from) {
      session_options how;
      how.out = folder / out;
      if (!from.empty()) how.restart = folder / from;
      long done = 0;
      how.watch = [&done](const simulation& now) { done = now.step(); };
      how.stop = [&done, steps] { return done >= steps; };
      run_session session(c, how);
      session.run();
      return outcome{session.computed().state(), session.records().history(), session.records().fields()};
    };
    const auto whole = run("whole", 1000, "");
    const auto steps = static_cast<long>(whole.history.rows.size()) - 1;
    ASSERT_GE(steps, 10);
    for (long at = 1; at < steps; ++at) {
      run("half", at, "");
      expect_same(whole, run("again", 1000, "half/checkpoint.h5"), fmt::format("{} from step {}", name, at));
    }
  }
}

TEST(equal_steps, a_checkpoint_without_the_earlier_values_is_refused) {
  simulation run(gas("imex-bdf-3", "dt = 0.002\nend = 0.02\n"));
  for (int n = 0; n < 6; ++n) run.advance();
  run_state saved = run.save();
  ASSERT_EQ(saved.kept.size(), 2U);
  simulation other(gas("imex-bdf-3", "dt = 0.002\nend = 0.02\n"));
  other.restore(saved);
  saved.kept[1].unknowns.pop_back();
  bad_input::expect_refused({
      {[&] { other.restore(saved); }, {"the saved state has another size"}},
  });
  saved.kept.pop_back();
  bad_input::expect_refused({
      {[&] { other.restore(saved); }, {"lacks values of earlier steps"}, 4},
  });
}

TEST(equal_steps, conserves_what_does_not_cross_the_walls_to_rounding) {
  for (const auto& name : names_of_several_steps()) {
    simulation run(gas(name, "dt = 0.002\nend = 0.2\n"));
    ASSERT_TRUE(run.promises().conservation) << name;
    while (!run.finished()) run.advance();
    // There are a hundred steps of a few roundings each. The energy through the walls is 1e-2.
    EXPECT_LT(run.summary().conservation_defect, 1e-13) << name;
    double received = 0.0;
    for (const double amount : run.last().received) received = std::max(received, std::abs(amount));
    EXPECT_GT(received, 1e-3) << name;
  }
}

TEST(equal_steps, begins_again_where_the_length_of_steps_changes) {
  for (const auto& [name, again] : {std::pair<std::string, std::string>{"imex-bdf-3", "2 steps"},
                                    {"imex-dimsim-3", "3 steps"},
                                    {"two-step-8-3-narrow", "1 step"}}) {
    testing::internal::CaptureStderr();
    const auto uneven = end_of(gas(name, "cfl = 0.1\nend = 0.05\n", "[output]\nevery = 0.0131\n"));
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                HasSubstr(fmt::format("'{}' begins again there with {} of '{}'", name, again,
                                      find_integrator(name).starter().name)));
    testing::internal::CaptureStderr();
    const auto even = end_of(gas(name, "cfl = 0.1\nend = 0.05\n"));
    // The last step, which ends at time.end, is shorter too, but no step follows.
    EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::Not(HasSubstr("begins again")));
    // Both are third-order approximations. Coefficients for equal steps in unequal ones would give a
    // difference of 5e-6.
    EXPECT_LT(distance(uneven, even) / distance(even, std::vector<double>(even.size(), 0.0)), 2e-6) << name;
  }
}

TEST(equal_steps, two_step_methods_promise_positivity_within_their_steps_and_others_do_not) {
  for (const auto& name : integrator_names("two-step")) {
    const simulation run(gas(name, "safety = 1\nend = 0.05\n"));
    EXPECT_FALSE(run.promises().positivity) << "WENO without the limiter";
    case_config limited = gas(name, "safety = 1\nend = 0.05\n");
    limited.space.limiter = limiter_choice::positivity;
    simulation kept(limited);
    EXPECT_TRUE(kept.promises().positivity) << name;
    while (!kept.finished()) kept.advance();
    EXPECT_EQ(kept.summary().negative_values, 0) << name;
  }
  case_config limited = gas("imex-bdf-2", "dt = 0.0005\nend = 0.05\n");
  limited.space.limiter = limiter_choice::positivity;
  EXPECT_FALSE(simulation(limited).promises().positivity);
}

TEST(equal_steps, methods_are_not_found_among_those_of_one_step) {
  bad_input::expect_refused({
      {[] { static_cast<void>(find_method("imex-bdf-3")); }, {"'imex-bdf-3' is a multistep method"}},
  });
}

}  // namespace equal_steps_test
