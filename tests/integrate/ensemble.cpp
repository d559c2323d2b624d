// Many systems side by side in lanes. Their derivatives, linear systems and steps agree with those
// of single systems.
#include <apsis/integrate/ensemble.hpp>

#include <apsis/integrate/newton_problem.hpp>
#include <apsis/method/time_integrator.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <integrate/random.hpp>
#include <integrate/robertson_ensemble.hpp>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace ensemble_test {
namespace {

using apsis::jet;
using apsis::lanes;
using random_input::uniform;

}  // namespace

TEST(jets, derivatives_agree_with_those_by_hand) {
  check_property("jets", [] {
    const double x = uniform(0.1, 3.0), y = uniform(0.1, 3.0);
    std::array<jet<2>, 2> u{jet<2>(x), jet<2>(y)};
    u[0].by[0] = 1.0;
    u[1].by[1] = 1.0;
    struct row {
      jet<2> f;
      double value, by_x, by_y;
    };
    const double e = std::exp(-x * y), s = std::sqrt(x + y);
    for (const auto& [f, value, by_x, by_y] : {
             row{exp(-u[0] * u[1]), e, -y * e, -x * e},
             row{u[0] / u[1] - 2.0 * u[1], x / y - 2 * y, 1 / y, -x / (y * y) - 2},
             row{sqrt(u[0] + u[1]), s, 0.5 / s, 0.5 / s},
             row{log(u[0]) * sin(u[1]), std::log(x) * std::sin(y), std::sin(y) / x,
                 std::log(x) * std::cos(y)},
             row{pow(u[0], 1.5) + cos(u[1]) * 3.0, std::pow(x, 1.5) + 3 * std::cos(y), 1.5 * std::sqrt(x),
                 -3 * std::sin(y)},
             row{lanes(2.0) * u[0] + 1.0, 2 * x + 1, 2, 0},
         })
      for (std::size_t k = 0; k < lanes::count; ++k) {
        const double size = 1e-13 * (1 + std::abs(value) + std::abs(by_x) + std::abs(by_y));
        EXPECT_NEAR(f.value[k], value, size);
        EXPECT_NEAR(f.by[0][k], by_x, size);
        EXPECT_NEAR(f.by[1][k], by_y, size);
      }
  });
}

TEST(lane_matrix, solves_what_eigen_solves_in_every_lane) {
  check_property("lane matrices", [] {
    constexpr std::size_t n = 5;
    std::array<Eigen::Matrix<double, n, n>, lanes::count> all;
    std::array<Eigen::Vector<double, n>, lanes::count> right;
    for (std::size_t k = 0; k < lanes::count; ++k)
      for (int i = 0; i < static_cast<int>(n); ++i) {
        right[k][i] = uniform(-1, 1);
        // Zero diagonals need row exchanges. These differ from lane to lane.
        for (int j = 0; j < static_cast<int>(n); ++j) all[k](i, j) = i == j ? 0.0 : uniform(-1, 1);
      }
    apsis::lane_matrix<n> matrix;
    std::array<lanes, n> r;
    for (std::size_t i = 0; i < n; ++i) {
      double row[lanes::count];
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < lanes::count; ++k)
          row[k] = all[k](static_cast<int>(i), static_cast<int>(j));
        matrix(i, j) = lanes::load(row);
      }
      for (std::size_t k = 0; k < lanes::count; ++k) row[k] = right[k][static_cast<int>(i)];
      r[i] = lanes::load(row);
    }
    matrix.factorize();
    matrix.solve(r);
    for (std::size_t k = 0; k < lanes::count; ++k) {
      // The solver is backward stable: the residual is as small as the rounding of the solution,
      // whatever the condition.
      Eigen::Vector<double, n> x;
      for (std::size_t i = 0; i < n; ++i) x[static_cast<int>(i)] = r[i][k];
      EXPECT_LT((all[k] * x - right[k]).norm(), 1e-13 * (1 + x.norm()));
    }
  });
}

TEST(lane_matrix, a_singular_matrix_spoils_its_lane_alone) {
  apsis::lane_matrix<2> matrix;
  const double diagonal[lanes::count] = {1, 2, 0, 4, 5, 6, 7, 8};
  matrix(0, 0) = matrix(1, 1) = lanes::load(diagonal);
  matrix(0, 1) = matrix(1, 0) = 0.0;
  std::array<lanes, 2> r{lanes(1.0), lanes(2.0)};
  matrix.factorize();
  matrix.solve(r);
  for (std::size_t k = 0; k < lanes::count; ++k)
    if (k == 2)
      EXPECT_FALSE(std::isfinite(r[0][k]));
    else
      EXPECT_EQ(r[1][k], 2.0 / diagonal[k]);
}

TEST(ensemble, every_system_is_as_accurate_as_its_tolerance_asks) {
  const std::size_t compared[] = {0, 7, 8, 20};
  std::vector<numbers> exact;
  const robertson_ensemble start(21);
  for (const std::size_t s : compared)
    exact.push_back(robertson_alone({start.parameters.begin() + static_cast<long>(3 * s),
                                     start.parameters.begin() + static_cast<long>(3 * s + 3)},
                                    1e4, 1e-9));
  for (const double tolerance : {1e-4, 1e-6, 1e-8})
    for (const char* method : {"extrapolated-euler-3", "extrapolated-euler-5", "ark-436", "ars-443"}) {
      // With the tolerance 1e-8, methods of order 3 would take some 10^4 steps.
      if (tolerance < 1e-7 && std::string(method) != "extrapolated-euler-5") continue;
      robertson_ensemble ensemble(21);
      ensemble.advance(apsis::find_method(method), 1e4, tolerance);
      for (std::size_t c = 0; c < exact.size(); ++c) {
        const double* u = &ensemble.u[3 * compared[c]];
        // Errors of steps add up to at most ten times the tolerance of a step.
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_NEAR(u[i], exact[c][i], 10 * tolerance * exact[c][i])
              << method << " " << compared[c] << " " << i;
        EXPECT_NEAR(u[0] + u[1] + u[2], 1.0, 1e-11) << method;  // G and the iterates conserve the sum
      }
    }
}

TEST(ensemble, reaches_late_times) {
  robertson_ensemble ensemble(8);
  const auto counts = ensemble.advance(apsis::find_method("extrapolated-euler-5"), 1e11, 1e-6);
  EXPECT_NEAR(ensemble.u[0] / 0.2083340149701255e-7, 1.0, 1e-4);
  EXPECT_NEAR(ensemble.u[1] / 0.8333360770334713e-13, 1.0, 1e-4);
  EXPECT_LT(counts.steps, 1000);
  EXPECT_LT(counts.matrices, counts.iterations / 2);  // most iterations use an earlier matrix
}

TEST(ensemble, parts_of_eight_have_the_bits_of_the_whole) {
  robertson_ensemble whole(24), parts(24);
  whole.advance(apsis::find_method("extrapolated-euler-5"), 1e3, 1e-5);
  for (const std::size_t first : {16u, 0u, 8u})
    apsis::integrate_ensemble<3, 3>(apsis::find_method("extrapolated-euler-5"), apsis::no_lane_transport{},
                                    robertson, std::span(parts.u).subspan(3 * first, 24),
                                    std::span(parts.parameters).subspan(3 * first, 24), 0.0, 1e3,
                                    of_robertson(1e-5));
  EXPECT_EQ(parts.u, whole.u);
}

TEST(ensemble, a_last_group_with_fewer_systems_is_complete) {
  robertson_ensemble one(1), nine(9);
  one.advance(apsis::find_method("extrapolated-euler-5"), 1e3, 1e-6);
  nine.advance(apsis::find_method("extrapolated-euler-5"), 1e3, 1e-6);
  EXPECT_NEAR(one.u[0], nine.u[0], 1e-5 * one.u[0]);
  robertson_ensemble copies(8);
  for (std::size_t k = 0; k < 24; ++k) copies.parameters[k] = rates[k % 3];
  copies.advance(apsis::find_method("extrapolated-euler-5"), 1e3, 1e-6);
  for (std::size_t k = 0; k < 24; ++k) EXPECT_EQ(copies.u[k], one.u[k % 3]);  // lanes are alike
  numbers nothing;
  const auto counts = apsis::integrate_ensemble<3>(apsis::find_method("ark-436"), apsis::no_lane_transport{},
                                                   robertson, nothing, {}, 0.0, 1.0, of_robertson(1e-4));
  EXPECT_EQ(counts.steps, 0);
}

TEST(ensemble, takes_an_explicit_part_and_time) {
  // u' = −k (u − cos t) − sin t is split into T = −sin t and Q = −k (u − cos t). The solution is u = cos t.
  const auto f = [](double t, auto, auto, auto out) { out[0] = -std::sin(t); };
  const auto g = [](double t, auto u, auto k, auto out) { out[0] = k[0] * (std::cos(t) - u[0]); };
  numbers u(11, 1.0), k;
  for (int s = 0; s < 11; ++s) k.push_back(std::pow(10.0, 0.5 * s));
  apsis::integrate_ensemble<1, 1>(apsis::find_method("extrapolated-euler-5"), f, g, u, k, 0.0, 3.0,
                                  tolerances(1e-7, 1e-7));
  for (const double x : u) EXPECT_NEAR(x, std::cos(3.0), 1e-6);
}

TEST(ensemble, names_the_system_that_fails) {
  numbers u(16, 0.1);
  u[11] = 2.0;
  const auto explodes = [](double, auto v, auto, auto out) { out[0] = v[0] * v[0]; };
  try {
    apsis::integrate_ensemble<1>(apsis::find_method("extrapolated-euler-4"), explodes,
                                 apsis::no_lane_transport{}, u, {}, 0.0, 1.0, tolerances(1e-6, 1e-6));
    ADD_FAILURE() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_GE(failure.site().cell, 8);
    EXPECT_LT(failure.site().cell, 16);
    EXPECT_NEAR(failure.site().t, 0.5, 1e-3);
  }
  EXPECT_NEAR(u[0], 0.1 / 0.9, 1e-5);  // groups before the failed one have reached the end
  EXPECT_EQ(u[11], 2.0);
  EXPECT_EQ(u[15], 0.1);
}

TEST(ensemble, refuses_what_lanes_cannot_do) {
  numbers u(6, 1.0), k(6, 1.0);
  const auto with = [&](const char* method) {
    return [&, method] {
      apsis::integrate_ensemble<3, 3>(apsis::find_method(method), apsis::no_lane_transport{}, robertson, u, k,
                                      0.0, 1.0, of_robertson(1e-4));
    };
  };
  bad_input::expect_refused({
      {with("md-imex-8-3-mixed"), {"'md-imex-8-3-mixed' has second derivatives"}},
      {with("exponential-2"), {"'exponential-2' has second derivatives or exact collisions"}},
      {[&] {
         apsis::integrate_ensemble<3, 3>(apsis::find_method("ark-436"), apsis::no_lane_transport{}, robertson,
                                         std::span(u).first(5), k, 0.0, 1.0, of_robertson(1e-4));
       },
       {"5 unknowns and 6 parameters do not fit"}},
      {[&] {
         numbers bad{1, 0, 0, 1, std::nan(""), 0};
         apsis::integrate_ensemble<3, 3>(apsis::find_method("ark-436"), apsis::no_lane_transport{}, robertson,
                                         bad, k, 0.0, 1.0, of_robertson(1e-4));
       },
       {"unknown 1 of system 1 is not finite"}},
      {[&] {
         apsis::integrate_ensemble<3, 3>(apsis::find_method("ark-436"), apsis::no_lane_transport{}, robertson,
                                         u, k, 1.0, 0.0, of_robertson(1e-4));
       },
       {"the time interval does not exist"}},
  });
}

}  // namespace ensemble_test
