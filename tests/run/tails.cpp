// Shakhov's target with its published, signed tails, and the effect of cut tails.
#include "same_results.hpp"

#include <apsis/config/case.hpp>
#include <apsis/run/promises.hpp>
#include <apsis/run/session.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/folder.hpp>

namespace tails_test {

using namespace apsis;
using testing::HasSubstr;
using testing::Not;

namespace {

/// A homogeneous gas with f = M [1 + q v_x (|v|² − 5)/5], integrated over unresolved velocities. Its heat
/// flux q decays like exp(−Pr t).
const std::string reduced = R"toml(
[parameters]
q = 0.1
[model]
name = "shakhov"
epsilon = 1
[initial]
g = "exp(-v_x^2/2)/sqrt(2*pi)*(1 + q*v_x*(v_x^2 - 3)/5)"
h = "exp(-v_x^2/2)/sqrt(2*pi)*(2 + q*v_x*(2*v_x^2 - 2)/5)"
[space]
cells = 8
[velocity]
max = 8
points = 32
[time]
method = "md-imex-8-3-mixed"
end = 1
dt = 0.05
)toml";

/// The same gas with all velocities, and a heat flux in every direction.
const std::string resolved = R"toml(
[parameters]
q = 0.1
[model]
name = "shakhov"
velocity_dimensions = 3
epsilon = 1
[initial]
f = "(2*pi)^(-3/2)*exp(-(v_x^2 + v_y^2 + v_z^2)/2)*(1 + q*(v_x + v_y + v_z)*(v_x^2 + v_y^2 + v_z^2 - 5)/5)"
[space]
cells = 3
formulation = "finite-difference"
reconstruction = "upwind1"
[velocity]
max = 7
points = 24
[time]
method = "md-imex-8-3-mixed"
end = 1
dt = 0.1
)toml";

double field_of(const simulation& run, const std::string& name) {
  const auto fields = run.fields();
  const auto at = std::find(fields.names.begin(), fields.names.end(), name) - fields.names.begin();
  return fields.values.at(static_cast<std::size_t>(at)).front();
}

/// Returns q(1)/q(0).
double decay(simulation& run, const std::string& name) {
  const double before = field_of(run, name);
  while (!run.finished()) run.advance();
  return field_of(run, name) / before;
}

simulation run_of(const std::string& text, const std::vector<std::string>& overrides) {
  return simulation(parse_case(text, "tails.toml", overrides));
}

const double published = std::exp(-2.0 / 3.0);

}  // namespace

TEST(tails, by_default_the_heat_flux_decays_with_the_prandtl_number_whatever_its_size) {
  for (const char* q : {"0.001", "0.1", "0.2", "0.5", "1.0"})
    for (const char* space : {"space.formulation=finite-volume", "space.formulation=finite-difference",
                              "space.collisions=centres"}) {
      auto run = run_of(reduced, {std::string("parameters.q=") + q, space});
      EXPECT_NEAR(field_of(run, "heat_flux"), std::stod(q), 1e-8) << "f is the given function";
      EXPECT_NEAR(field_of(run, "stress"), 0.0, 1e-8);
      // The error is of third order, with steps of a twentieth of the relaxation time.
      EXPECT_NEAR(decay(run, "heat_flux"), published, 1e-5) << q << space;
      EXPECT_EQ(run.summary().largest_cut, 0.0);
      EXPECT_FALSE(run.promises().positivity);
    }
}

TEST(tails, decay_with_the_prandtl_number_in_three_dimensions) {
  auto run = run_of(resolved, {"parameters.q=0.2"});
  EXPECT_NEAR(field_of(run, "heat_flux_x"), 0.2, 1e-6);
  EXPECT_NEAR(decay(run, "heat_flux_z"), published, 1e-5);
  EXPECT_NEAR(field_of(run, "heat_flux_y"), 0.2 * published, 1e-5);
}

TEST(tails, that_are_cut_off_make_another_gas_and_the_run_measures_how_much) {
  // A nonnegative target is not cut, so all bits agree.
  const std::vector<std::string> weak = {"parameters.q=0.001"},
                                 cut_weak = {"parameters.q=0.001", "model.tails=nonnegative"};
  auto whole = run_of(reduced, weak), bounded = run_of(reduced, cut_weak);
  decay(whole, "heat_flux");
  decay(bounded, "heat_flux");
  EXPECT_TRUE(same_bits(whole.state(), bounded.state()));
  EXPECT_EQ(bounded.summary().largest_cut, 0.0);
  // A larger q means a larger cut. In the end all of the term in q is cut, which leaves BGK with Pr = 1.
  double last = published;
  for (const char* q : {"0.1", "0.2", "0.5"}) {
    auto run = run_of(reduced, {std::string("parameters.q=") + q, "model.tails=nonnegative"});
    const double now = decay(run, "heat_flux");
    EXPECT_LT(now, last - 1e-3) << q;
    EXPECT_GT(run.summary().largest_cut, harmless_cut) << q;
    last = now;
  }
  EXPECT_NEAR(last, std::exp(-1.0), 2e-3);
}

TEST(tails, the_log_states_the_missing_promise_and_a_cut_once) {
  const auto messages = [](const std::string& tails) {
    testing::internal::CaptureStderr();
    run_session session(parse_case(reduced, "tails.toml", {"model.tails=" + tails, "parameters.q=0.2"}), {});
    session.run();
    return testing::internal::GetCapturedStderr();
  };
  const std::string of_published = messages("signed"), of_cut = messages("nonnegative");
  EXPECT_THAT(of_published, HasSubstr("; positivity is not promised (the target of the model as published is "
                                      "negative far from the bulk velocity); model.tails = \"nonnegative\""));
  EXPECT_THAT(of_published, Not(HasSubstr("warning: the rate")));
  EXPECT_THAT(of_cut, Not(HasSubstr("positivity is not promised")));
  const std::string warned = "warning: the rate at which the heat flux relaxes is changed by ";
  ASSERT_THAT(of_cut, HasSubstr(warned));
  EXPECT_EQ(of_cut.find(warned), of_cut.rfind(warned)) << of_cut;
  EXPECT_THAT(of_cut, HasSubstr("use model.tails = \"signed\" for the model as published"));
}

TEST(tails, the_cut_is_in_history_and_summary_also_after_a_restart) {
  const test_folder folder;
  const auto c = parse_case(reduced, "tails.toml", {"model.tails=nonnegative", "parameters.q=0.2"});
  const auto run = [&](const std::string& out, long steps, std::optional<std::string> from = {}) {
    session_options how;
    how.out = folder / out;
    how.restart = std::move(from);
    long done = 0;
    how.watch = [&done](const simulation& now) { done = now.step(); };
    how.stop = [&done, steps] { return done >= steps; };
    run_session session(c, how);
    session.run();
    return std::pair(
        outcome{session.computed().state(), session.records().history(), session.records().fields()},
        session.computed().summary().largest_cut);
  };
  const auto [whole, largest] = run("whole", 1000);
  run("part", 7);
  const auto [continued, same] = run("rest", 1000, folder / "part/checkpoint.h5");
  expect_same(whole, continued, "restart");
  EXPECT_EQ(largest, same);
  const auto& names = whole.history.columns;
  const auto column = std::find(names.begin(), names.end(), "cut_heat_flux");
  ASSERT_NE(column, names.end());
  double most = 0.0;
  for (const auto& row : whole.history.rows)
    most = std::max(most, row[static_cast<std::size_t>(column - names.begin())]);
  EXPECT_EQ(most, largest);
  EXPECT_GT(most, harmless_cut);
}

TEST(tails, models_without_a_target_that_can_be_cut_have_no_such_column) {
  for (const char* model : {"bgk", "shakhov", "es-bgk"}) {
    const auto c =
        parse_case(reduced, "tails.toml", {std::string("model.name=") + model, "model.degrees_of_freedom=3"});
    const simulation run(c);
    const run_records records(run);
    const auto& names = records.history().columns;
    const auto count = std::count_if(names.begin(), names.end(),
                                     [](const std::string& one) { return one.rfind("cut_", 0) == 0; });
    EXPECT_EQ(count, std::string(model) == "bgk" ? 0 : 1) << model;
    EXPECT_EQ(c.model.options.contains("tails"), std::string(model) != "bgk");
  }
}

}  // namespace tails_test
