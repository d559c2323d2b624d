// Sources: balances, order in time and space, limits, refusals.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace source_test {

namespace {

using apsis::simulation;
using testing::HasSubstr;

const std::string gas = R"toml(
[model]
name = "bgk"
degrees_of_freedom = 3
epsilon = 0.1
[initial]
rho = 1
T = 1
[space]
cells = 12
limiter = "positivity"
[velocity]
max = 8
points = 24
[time]
method = "md-imex-6-3"
safety = 1
end = 0.5
)toml";

simulation run_of(const std::string& more, const std::vector<std::string>& overrides = {}) {
  return simulation(apsis::parse_case(gas + more, "source.toml", overrides));
}

void finish(simulation& run) {
  while (!run.finished()) run.advance();
}

double received(const simulation& run, const std::string& from, const std::string& invariant) {
  const auto names = run.setup().equation->invariants(), faces = run.setup().open_faces();
  const auto k = std::find(names.begin(), names.end(), invariant) - names.begin(),
             f = std::find(faces.begin(), faces.end(), from) - faces.begin();
  return run.last().received[static_cast<std::size_t>(f) * names.size() + static_cast<std::size_t>(k)];
}

}  // namespace

TEST(source, gives_its_mass_momentum_and_energy) {
  for (const char* formulation : {"finite-volume", "finite-difference"}) {
    simulation run = run_of("[source]\nrho = \"1 + sin(2*pi*x)\"\nu = 0.4\nT = 1.5\n",
                            {std::string("space.formulation=") + formulation});
    EXPECT_TRUE(run.promises().positivity);
    EXPECT_FALSE(run.promises().entropy);
    finish(run);
    EXPECT_LT(run.summary().conservation_defect, 1e-14);
    // The rate is constant in time. Sums of sines over equidistant cells vanish.
    EXPECT_NEAR(received(run, "source", "mass"), 0.5, 1e-14);
    EXPECT_NEAR(received(run, "source", "momentum"), 0.5 * 0.4, 1e-14);
    EXPECT_NEAR(received(run, "source", "energy"), 0.5 * 0.5 * (0.16 + 3.0 * 1.5), 1e-14);
  }
}

TEST(source, closes_the_balance_with_a_force_and_heated_walls) {
  simulation run = run_of(
      "[source]\nrho = \"x > 0.5 ? 0.5*t : 0\"\nT = 1\n[force]\nacceleration = \"0.3*cos(5*t)\"\n"
      "[boundary.left]\nkind = \"diffuse\"\nT = \"1 + 0.2*sin(9*t)\"\n[boundary.right]\nkind = "
      "\"diffuse\"\n");
  finish(run);
  EXPECT_EQ(run.setup().open_faces(), (std::vector<std::string>{"left", "right", "force", "source"}));
  EXPECT_LT(run.summary().conservation_defect, 1e-13);
  EXPECT_GT(received(run, "source", "mass"), 0.03);
  EXPECT_GT(std::abs(received(run, "force", "momentum")), 0.01);
  EXPECT_EQ(run.summary().negative_values, 0);
}

TEST(source, has_the_order_of_the_method_in_time) {
  // The mass of the gas is the integral of the source by the quadrature of the stages.
  const auto error = [](int steps) {
    simulation run = run_of("[source]\nrho = \"(1 - exp(-4*t))^2\"\nT = 1\n",
                            {fmt::format("time.dt={:.17g}", 0.5 / steps), "space.limiter=none"});
    finish(run);
    const double exact = 0.5 - (1.0 - std::exp(-2.0)) / 2.0 + (1.0 - std::exp(-4.0)) / 8.0;
    return std::abs(received(run, "source", "mass") - exact);
  };
  // At these steps the next term changes the slope by a tenth.
  EXPECT_NEAR(std::log2(error(40) / error(80)), 3.0, 0.15);
}

TEST(source, has_its_limit_solution_with_third_order) {
  // As ε → 0 a gas at rest stays at rest if its pressure is uniform. With the rate s = 1 + sin(2πx)/2 and the
  // temperature 1/s the pressure is 1 + t. The density is 1 + 0.3 cos(2πx) + ts.
  const std::string more = "[source]\nrho = \"1 + sin(2*pi*x)/2\"\nT = \"1/(1 + sin(2*pi*x)/2)\"\n";
  const auto error = [&](int cells) {
    simulation run =
        run_of(more, {"model.epsilon=1e-9", "initial.rho=\"1 + 0.3*cos(2*pi*x)\"",
                      "initial.T=\"1/(1 + 0.3*cos(2*pi*x))\"", fmt::format("space.cells={}", cells),
                      "velocity.max=9", "velocity.points=30", "space.formulation=finite-difference"});
    finish(run);
    const auto fields = run.fields();
    double sum = 0.0;
    for (int i = 0; i < cells; ++i) {
      const double phase = 2.0 * std::numbers::pi * (i + 0.5) / cells,
                   exact = 1.0 + 0.3 * std::cos(phase) + 0.5 * (1.0 + 0.5 * std::sin(phase));
      sum += std::abs(fields.values.front()[static_cast<std::size_t>(i)] - exact) / cells;
    }
    return sum;
  };
  const double coarse = error(16), fine = error(32);
  EXPECT_LT(fine, 2e-4);
  EXPECT_GT(std::log2(coarse / fine), 2.8);
}

TEST(source, flows_out_at_its_rate_in_the_steady_state) {
  simulation run = run_of(
      "[source]\nrho = 0.3\nT = 1\n[boundary.left]\nkind = \"inflow\"\nrho = 1e-9\nT = 1\n"
      "[boundary.right]\nkind = \"inflow\"\nrho = 1e-9\nT = 1\n",
      {"model.epsilon=1e12", "time.end=300", "time.steady=1e-7"});
  finish(run);
  const auto& flux = run.last().flux;  // [face][invariant] of three invariants
  EXPECT_NEAR(flux[0] + flux[3], -0.3, 1e-6);
  EXPECT_NEAR(flux[0], flux[3], 1e-7);
  EXPECT_NEAR(flux[6], 0.3, 1e-14);
}

TEST(source, is_a_function_of_the_velocity) {
  // If g and h have the formula of a Maxwellian, the source is that of its moments, up to the mass
  // beyond the grid.
  simulation f = run_of(
                 "[source]\ng = \"(1 + t)*exp(-(v_x - 0.3)^2/2)/sqrt(2*pi)\"\nh = \"2*(1 + t)*exp(-(v_x - "
                 "0.3)^2/2)/sqrt(2*pi)\"\n"),
             moments = run_of("[source]\nrho = \"1 + t\"\nu = 0.3\nT = 1\n");
  finish(f);
  finish(moments);
  for (const char* invariant : {"mass", "momentum", "energy"})
    EXPECT_NEAR(received(f, "source", invariant), received(moments, "source", invariant), 1e-11) << invariant;
}

TEST(source, that_becomes_negative_ends_the_run) {
  // The source becomes negative at a later time, which only the run can detect.
  simulation run = run_of("[source]\nrho = \"0.01 - t\"\nT = 1\n");
  EXPECT_THROW(finish(run), apsis::numerical_error);
}

namespace {

/// Returns a case of shallow water on 40 cells with a source.
std::string water_with(const std::string& source, const std::string& step = "cfl = 0.5") {
  return fmt::format(R"toml(
[model]
name = "conservation-law"
variables = ["h", "q"]
flux = ["q", "q^2/h + h^2/2"]
speed = 4
epsilon = 1e-8
[initial]
h = 1
q = 0.5
[space]
cells = 40
formulation = "finite-difference"
[time]
method = "md-imex-6-3"
end = 1
{}
[source]
{})toml",
                     step, source);
}

simulation finished(const std::string& text, const std::vector<std::string>& overrides = {}) {
  simulation run(apsis::parse_case(text, "law.toml", overrides));
  finish(run);
  return run;
}

}  // namespace

TEST(source, of_a_law_depends_on_its_variables) {
  // Uniform water with the friction −3q|q|/h satisfies q' = −3q² from 1/2. h has no source and stays 1.
  const auto error = [](double dt) {
    const simulation run = finished(water_with("q = \"-3*q*abs(q)/h\"\n"), {fmt::format("time.dt={}", dt)});
    const auto fields = run.fields();
    for (const double h : fields.values[0]) EXPECT_NEAR(h, 1.0, 1e-14);
    return std::abs(fields.values[1].front() - 0.5 / (1.0 + 1.5));
  };
  const double coarse = error(0.02), fine = error(0.01);
  // The method has order 3, and the next term changes the slope by a tenth.
  EXPECT_NEAR(std::log2(coarse / fine), 3.0, 0.2);
  EXPECT_LT(fine, 1e-5);
}

TEST(source, of_a_law_keeps_the_balance_of_what_it_gives) {
  // The balances contain rain and friction over a wave, also on averages.
  for (const char* form : {"finite-volume", "finite-difference"}) {
    const simulation run =
        finished(water_with("h = \"0.1*x\"\nq = \"-q/h\"\n"),
                 {"initial.q=\"0.3*sin(2*pi*x)\"", fmt::format("space.formulation={}", form)});
    EXPECT_LT(run.summary().conservation_defect, 1e-13) << form;
    EXPECT_NEAR(received(run, "source", "h"), 0.05, 1e-14) << form;
  }
}

TEST(source, of_a_law_adds_no_term_of_size_epsilon) {
  // u_t + (u²/2)_x = −u with uniform data. u = e^−t is exact for every ε, because the
  // source keeps equilibria.
  const std::string text = R"toml(
[model]
name = "NAME"
KEYS
speed = 2
epsilon = 0.05
[initial]
VARIABLE = 1
[source]
VARIABLE = "-VARIABLE"
[space]
cells = 8
[time]
method = "md-imex-6-3"
dt = 0.01
end = 1
)toml";
  const auto replaced = [&text](const std::string& name, const std::string& keys,
                                const std::string& variable) {
    std::string out = text;
    for (const auto& [from, to] :
         {std::pair<std::string, std::string>{"NAME", name}, {"KEYS", keys}, {"VARIABLE", variable}})
      for (auto at = out.find(from); at != std::string::npos; at = out.find(from, at + to.size()))
        out.replace(at, from.size(), to);
    return out;
  };
  const simulation law =
                       finished(replaced("conservation-law", "variables = [\"u\"]\nflux = [\"u^2/2\"]", "u")),
                   relaxation = finished(replaced("relaxation", "flux = \"burgers\"", "u1"));
  // The error of the method is 1e-8. A source of another flux would make the flux wrong by ε.
  EXPECT_NEAR(law.fields().values[0].front(), std::exp(-1.0), 1e-7);
  EXPECT_NEAR(relaxation.fields().values[0].front(), std::exp(-1.0), 1e-7);
  EXPECT_NEAR(relaxation.fields().values[1].front(), 0.5 * std::exp(-2.0), 1e-6);
}

TEST(source, that_is_faster_than_the_steps_is_reported_and_limits_safety) {
  testing::internal::CaptureStderr();
  simulation(apsis::parse_case(water_with("q = \"-1000*q\"\n"), "law.toml"));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("the source is too fast for the step"));
  testing::internal::CaptureStderr();
  simulation(apsis::parse_case(water_with("q = \"-q\"\n"), "law.toml"));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::Not(HasSubstr("too fast")));
  simulation safe(
      apsis::parse_case(water_with("q = \"-1000*q\"\n", "safety = 1"), "law.toml", {"time.end=0.05"}));
  EXPECT_LT(safe.dt(), 1e-3);
  finish(safe);
  EXPECT_NEAR(safe.fields().values[1].front(), 0.0, 1e-6);
}

TEST(source, of_a_law_that_has_no_value_ends_the_run_with_its_state) {
  bad_input::expect_refused({{[&] { finished(water_with("q = \"-sqrt(0.3 - t)*q\"\n")); },
                              {"'source.q' is ", "at h = 1, q = 0."},
                              3}});
}

TEST(source, of_a_conservation_law_is_that_of_its_variables) {
  simulation run(apsis::parse_case(R"toml(
[model]
name = "relaxation"
[initial]
u1 = 1
[source]
u1 = "1 + x"
[space]
cells = 20
[time]
method = "md-imex-3-2"
safety = 0.5
end = 0.4
)toml",
                                   "law.toml"));
  finish(run);
  EXPECT_NEAR(run.last().total[0], 1.0 + 0.4 * 1.5, 1e-13);
  EXPECT_LT(run.summary().conservation_defect, 1e-12);
}

}  // namespace source_test
