// Linear stability limits, time.safety relative to them, and instabilities that a run detects.
#include "gas_between_walls.hpp"

#include <apsis/core/log.hpp>
#include <apsis/method/amplification.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/run/cfl_limit.hpp>
#include <apsis/run/session.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stability_test {

using namespace apsis;
using testing::HasSubstr;
using testing::Not;

namespace {

double limit_of(const std::string& method, const std::string& scheme) {
  const auto reconstruct = find_reconstruction(scheme).make();
  return cfl_limit(find_integrator(method).growth(), *reconstruct);
}

/// Returns a case of heat between plates with 12 half-range velocities. The temperatures differ by 2 %.
case_config plates(const std::string& method, const std::string& scheme, const std::string& time,
                   double delta = 10.0, double end = 6.0) {
  return parse_case(fmt::format(R"toml([model]
name = "bgk"
degrees_of_freedom = 3
collision_rate = "viscosity"
viscosity_exponent = 0.5
epsilon = "1/(sqrt(2)*{})"
[initial]
rho = "1/(1 + 0.01*(1 - 2*x))"
T = "1 + 0.01*(1 - 2*x)"
[space]
cells = 40
formulation = "finite-difference"
limiter = "none"
reconstruction = "{}"
[boundary.left]
kind = "diffuse"
T = 1.01
[boundary.right]
kind = "diffuse"
T = 0.99
[velocity]
set = "half-range-gauss-hermite"
points = 12
[time]
method = "{}"
end = {}
{}
)toml",
                                delta, scheme, method, end, time),
                    "plates.toml");
}

/// Returns the heat at the left plate after every step.
std::vector<double> fluxes_of(const case_config& c) {
  simulation run(c);
  const std::size_t energy = run.setup().equation->invariants().size() - 1;
  std::vector<double> flux;
  while (!run.finished()) flux.push_back(run.advance().flux[energy]);
  return flux;
}

/// Returns the largest relative deviation of a flux from the mean of its neighbours, in the last fifth
/// of the steps.
double alternation_of(const std::vector<double>& flux) {
  double largest = 0.0;
  for (std::size_t k = flux.size() - flux.size() / 5; k + 1 < flux.size(); ++k)
    largest = std::max(largest, std::abs(flux[k] - (flux[k - 1] + flux[k + 1]) / 2.0));
  return largest / std::abs(flux.back());
}

std::string log_of(const case_config& c) {
  testing::internal::CaptureStderr();
  try {
    simulation run(c);
    while (!run.finished()) run.advance();
  } catch (const numerical_error& failure) {
    return testing::internal::GetCapturedStderr() + "ended: " + failure.what();
  }
  return testing::internal::GetCapturedStderr();
}

}  // namespace

TEST(linear_edges, of_all_reconstructions_are_exact_for_their_polynomials) {
  for (const reconstruction_entry* one : reconstruction_entries()) {
    const auto scheme = one->make();
    const auto edge = linear_edge(*scheme);
    const int g = scheme->ghost_width();
    // Averages of x^p over [k − 1/2, k + 1/2] must give (1/2)^p. Differences over 1e-7 have 9 digits.
    for (int p = 0; p < scheme->order(); ++p) {
      double sum = 0.0;
      for (int k = -g; k <= g; ++k)
        sum += edge[static_cast<std::size_t>(k + g)] * (std::pow(k + 0.5, p + 1) - std::pow(k - 0.5, p + 1)) /
               (p + 1);
      EXPECT_NEAR(sum, std::pow(0.5, p), 1e-6) << one->name << ", degree " << p;
    }
  }
}

// In several directions z is a mean of points of the curve. The limit of one direction thus holds for the sum
// of the CFL numbers.
TEST(transport_symbols, of_all_reconstructions_enclose_a_convex_region_without_growth) {
  for (const reconstruction_entry* one : reconstruction_entries()) {
    const auto edge = linear_edge(*one->make());
    constexpr int count = 400;
    std::vector<std::complex<double>> z;
    for (int k = 0; k <= 2 * count; ++k) z.push_back(transport_symbol(edge, std::numbers::pi * k / count));
    for (std::size_t k = 1; k + 1 < z.size(); ++k) {
      const auto before = z[k] - z[k - 1], after = z[k + 1] - z[k];
      EXPECT_LE(z[k].real(), 1e-8) << one->name;
      // The curve turns in one direction only. The coefficients have rounding errors of 1e-9.
      EXPECT_LE(before.real() * after.imag() - before.imag() * after.real(), 1e-8) << one->name << ", " << k;
    }
  }
}

// The limit is 1.43 for SSPRK(3,3) with WENO5 (Motamed, Macdonald, Ruuth, J. Sci. Comput. 47 (2011) 127–149).
// With upwind1 the real axis determines the limits 2.5127/2 and 2.7853/2.
TEST(cfl_limits, of_known_methods_are_those_of_the_literature) {
  EXPECT_NEAR(limit_of("ssprk-3-3", "weno5-z"), 1.43, 0.01);
  EXPECT_NEAR(limit_of("ssprk-3-3", "weno5-js"), 1.43, 0.01);
  EXPECT_NEAR(limit_of("ssprk-3-3", "upwind1"), 2.5127 / 2.0, 2e-3);
  EXPECT_NEAR(limit_of("kutta-4", "upwind1"), 2.7853 / 2.0, 2e-3);
  EXPECT_NEAR(limit_of("forward-backward-euler", "upwind1"), 1.0, 2e-3);
  // Order 2 amplifies waves that fifth order does not damp. Euler's method amplifies every wave.
  EXPECT_LT(limit_of("ssprk-2-2", "upwind5"), 0.5);
  EXPECT_LT(limit_of("forward-backward-euler", "upwind5"), 0.02);
}

// Strong stability in the 2-norm: upwind1 up to CFL 1 and collisions are contractions. Safety is therefore
// the same with upwind1.
TEST(cfl_limits, with_first_order_upwind_are_at_least_the_ssp_coefficient) {
  std::vector<std::string> names = method_names();
  names.insert(names.end(), {"md-imex-chain-7-2", "md-imex-plateau-free-6-2", "exponential-2"});
  for (const auto& name : names) {
    const method& m = find_method(name);
    if (m.kind == method_kind::implicit_only) continue;
    const certificate& c = find_certificate(name);
    if (!c.bounded) continue;
    EXPECT_GE(limit_of(name, "upwind1"), c.ssp_coefficient.convert_to<double>()) << name;
  }
  for (const auto& name : names_of_several_steps())
    EXPECT_GE(limit_of(name, "upwind1"), find_integrator(name).ssp_coefficient) << name;
}

// A matrix confirms the definition for the gas of two velocities, f±_t ± f±_x = (ρ(1 ± a)/2 − f±)/ε. With
// every θ, a and Δt/ε it does not grow at a few per cent below the limit. Transport alone grows above it.
TEST(cfl_limits, keep_a_relaxing_gas_of_two_velocities_stable) {
  using complex = std::complex<double>;
  using matrix2 = std::array<std::array<complex, 2>, 2>;
  for (const char* name : {"md-imex-5-2", "md-imex-3-2", "md-imex-6-2-mixed", "md-imex-9-3-large-r"}) {
    const double nu = limit_of(name, "upwind5");
    const auto form = find_method(name).coefficients<double>();
    const auto initial = initial_weights(form);
    const auto edge = linear_edge(*find_reconstruction("upwind5").make());
    double largest = 0.0, above = 0.0;
    for (int k = 1; k <= 24; ++k) {
      const complex symbol = transport_symbol(edge, std::numbers::pi * k / 24);
      for (const double a : {0.0, 0.6, 1.0})
        for (const double s : {0.0, 0.1, 1.0, 10.0, 1e4})
          for (const double number : {0.98 * nu, 1.3 * nu}) {
            const std::array<complex, 2> z = {number * symbol, number * std::conj(symbol)};
            std::vector<matrix2> stages;
            for (std::size_t i = 0; i < form.stages(); ++i) {
              matrix2 u{};
              for (std::size_t row = 0; row < 2; ++row)
                for (std::size_t column = 0; column < 2; ++column) {
                  complex sum = row == column ? initial[i] : 0.0;
                  for (std::size_t j = 0; j < i; ++j)
                    sum += (form.P(i, j) + form.W(i, j) * (1.0 + z[row] / form.r)) * stages[j][row][column];
                  u[row][column] = sum;
                }
              const double kept = 1.0 / (1.0 + form.D(i, i) * s - form.ddot[i] * s * s);
              for (std::size_t column = 0; column < 2; ++column) {
                const complex rho = u[0][column] + u[1][column];
                const std::array<complex, 2> e = {rho * (1.0 + a) / 2.0, rho * (1.0 - a) / 2.0};
                for (std::size_t row = 0; row < 2; ++row)
                  u[row][column] = e[row] + kept * (u[row][column] - e[row]);
              }
              stages.push_back(u);
            }
            const matrix2& R = stages.back();
            const complex trace = R[0][0] + R[1][1], det = R[0][0] * R[1][1] - R[0][1] * R[1][0],
                          root = std::sqrt(trace * trace / 4.0 - det);
            const double factor = std::max(std::abs(trace / 2.0 + root), std::abs(trace / 2.0 - root));
            (number < nu ? largest : above) =
                std::max(number < nu ? largest : above, std::log(factor) / number);
          }
    }
    EXPECT_LE(largest, growth_per_cell * 1.01) << name;
    EXPECT_GT(above, growth_per_cell) << name;
  }
}

TEST(safety_without_limiter, comes_to_rest_between_plates_with_every_reconstruction) {
  for (const char* method : {"md-imex-5-2", "md-imex-3-2", "md-imex-6-2-mixed", "md-imex-9-3-large-r"})
    for (const char* scheme : {"weno5-z", "weno5-js", "upwind5"})
      // The slow approach to the steady state changes the flux by 1e-5 in a step. So does a change of the
      // step before the end. Beyond the limit the flux alternates by 3e-4 to 400.
      EXPECT_LT(alternation_of(fluxes_of(plates(method, scheme, "safety = 1"))), 3e-5)
          << method << ", " << scheme;
}

// The mean flux of a step depends on Δt/ε. After a last step of another length the heat flux was wrong by
// 3e-3 to 1.5 here.
TEST(the_last_row_of_the_history, belongs_to_a_step_like_those_before_it) {
  for (const char* method : {"md-imex-8-3-mixed", "md-imex-3-2", "md-imex-6-3"})
    for (const double end : {0.5, 0.5031, 0.5077}) {
      const auto flux = fluxes_of(plates(method, "weno5-z", "safety = 1", 1000.0, end));
      // The flux changes by 1e-4 in a step while heat diffuses.
      EXPECT_NEAR(flux.back() / flux[flux.size() - 2], 1.0, 5e-4) << method << ", " << end;
    }
}

TEST(safety, is_r_where_r_is_stable_and_with_a_limiter_of_edges) {
  const run_setup mixed(plates("md-imex-8-3-mixed", "weno5-z", "safety = 1"));
  EXPECT_EQ(mixed.step_coefficient(), mixed.ssp_coefficient());
  EXPECT_EQ(mixed.ssp_coefficient(), 1.25);
  case_config limited = plates("md-imex-5-2", "weno5-z", "safety = 1");
  limited.space.limiter = limiter_choice::positivity;
  EXPECT_EQ(run_setup(limited).step_coefficient(), run_setup(limited).stability_limit());
  // Collisions at Gauss points need the limiter of edges, with a twelfth of the step.
  limited.space.discretization = "finite-volume";
  EXPECT_EQ(run_setup(limited).step_coefficient(), 2.0);
  const run_setup second(plates("md-imex-5-2", "weno5-z", "safety = 1"));
  EXPECT_EQ(second.step_coefficient(), second.stability_limit());
  EXPECT_LT(second.stability_limit(), 0.7);
  EXPECT_EQ(run_setup(plates("md-imex-5-2", "upwind1", "safety = 1")).step_coefficient(), 2.0);
  // A method without r has a limit of its own.
  const run_setup ark(plates("ars-443", "weno5-z", "safety = 0.9"));
  EXPECT_EQ(ark.ssp_coefficient(), 0.0);
  EXPECT_GT(ark.step_coefficient(), 0.5);
}

TEST(a_step_beyond_the_limit, is_reported_before_the_run) {
  const auto log = log_of(plates("md-imex-8-3-mixed", "upwind5", "cfl = 2.5", 10.0, 1.0));
  EXPECT_THAT(log, HasSubstr("waves of some cells grow (CFL number 2.5; the linear stability limit of "
                             "'md-imex-8-3-mixed' with 'upwind5' is 1.86); use time.cfl = 1.8 or less"));
  EXPECT_THAT(log_of(plates("md-imex-8-3-mixed", "upwind5", "cfl = 1.8", 10.0, 0.05)),
              Not(HasSubstr("grow")));
  EXPECT_THAT(log_of(plates("forward-backward-euler", "weno5-z", "safety = 1", 10.0, 0.001)),
              HasSubstr("choose a method of order 3"));
}

TEST(an_instability, is_noticed_during_the_run_and_ends_it_before_overflow) {
  for (const char* method :
       {"md-imex-5-2", "md-imex-6-2-mixed", "md-imex-8-3-mixed", "md-imex-16-4-efficient"})
    for (const double beyond : {2.5, 4.0}) {
      const double cfl = beyond * limit_of(method, "upwind5");
      const auto log = log_of(plates(method, "upwind5", fmt::format("cfl = {}", cfl)));
      // Fast growth breaks conservation before eight steps are judged, because large values of
      // both signs cancel.
      EXPECT_THAT(log, testing::AnyOf(HasSubstr("ended: the solution is lost to an instability"),
                                      HasSubstr("because the steps are unstable (CFL number")))
          << method << ", " << beyond;
      EXPECT_THAT(log, Not(HasSubstr("not finite"))) << method;
    }
}

TEST(an_instability, that_the_weights_of_weno_bound_is_noticed_too) {
  for (const char* scheme : {"weno5-js", "weno5-z"})
    EXPECT_THAT(log_of(plates("md-imex-5-2", scheme, "cfl = 2")), HasSubstr("the solution is unstable"))
        << scheme;
}

// The limiter keeps f >= 0 up to CFL 2 = r, but it does not keep waves from growing.
TEST(an_instability, that_the_limiter_bounds_is_noticed_too) {
  for (const char* scheme : {"weno5-js", "weno5-z"}) {
    case_config limited = plates("md-imex-5-2", scheme, "cfl = 2");
    limited.space.limiter = limiter_choice::positivity;
    EXPECT_THAT(log_of(limited), HasSubstr("the solution is unstable")) << scheme;
  }
}

TEST(an_instability, is_not_reported_for_shocks_jets_and_walls_in_stable_steps) {
  const char* data[] = {"rho = \"x < 0.5 ? 1 : 0.01\"\nT = \"x < 0.5 ? 1 : 0.8\"",
                        "rho = 1\nu = \"x < 0.5 ? 2 : -2\"\nT = 1", "rho = \"1 + 0.9*sin(14*pi*x)\"\nT = 1"};
  for (const char* initial : data)
    for (const char* scheme : {"upwind1", "upwind5", "weno5-js", "weno5-z"})
      for (const char* epsilon : {"1e-6", "1e-2", "10"})
        for (const char* ends : {"outflow", "diffuse", "periodic"}) {
          const auto c = parse_case(
              fmt::format("[model]\nname = \"bgk\"\nepsilon = {}\n[initial]\n{}\n[space]\ncells = 60\n"
                          "boundary = \"{}\"\nreconstruction = \"{}\"\nformulation = \"finite-difference\"\n"
                          "[velocity]\nmax = 9\npoints = 30\n[time]\nmethod = \"md-imex-8-3-mixed\"\n"
                          "safety = 1\nend = 0.2\n",
                          epsilon, initial, ends, scheme),
              "case.toml");
          EXPECT_THAT(log_of(c), Not(HasSubstr("unstable"))) << initial << scheme << epsilon << ends;
        }
}

}  // namespace stability_test
