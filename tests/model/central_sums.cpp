// Central moments of rows on velocity grids, and the conservative targets that follow from them.
#include <apsis/model/central_sums.hpp>

#include <apsis/model/correlated_gaussian.hpp>
#include <apsis/model/gas_target.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/instruction_sets.hpp>

namespace central_sums_test {

namespace {

using row = std::vector<double>;

double number(double from, double to) {
  return from + (to - from) * *rc::gen::inRange(0, 10'001) / 1e4;
}

/// Returns lines of different lengths, uniform or with unequal spacing and weights, or rings about an axis.
apsis::velocity_grid any_grid(int dimensions) {
  if (dimensions == 3 && *rc::gen::arbitrary<bool>())
    return {apsis::velocity_line(*rc::gen::inRange(4, 11), number(3.0, 8.0)),
            apsis::polar_rings(*rc::gen::inRange(4, 8), 4 * *rc::gen::inRange(3, 5), number(3.0, 8.0)),
            *rc::gen::element(0, 2)};
  const bool uniform = *rc::gen::arbitrary<bool>();
  std::vector<apsis::velocity_line> lines;
  for (int k = 0; k < dimensions; ++k) {
    const int n = *rc::gen::inRange(4, dimensions == 3 ? 11 : 40);
    if (uniform) {
      lines.emplace_back(n, number(3.0, 8.0));
      continue;
    }
    std::vector<double> v, w;
    for (int j = 0; j < n; ++j) {
      v.push_back((j == 0 ? -4.0 : v.back()) + number(0.1, 1.0));
      w.push_back(number(0.1, 1.0));
    }
    lines.emplace_back(v, w);
  }
  return apsis::velocity_grid(std::move(lines));
}

}  // namespace

RC_GTEST_PROP(central_sums, are_those_of_long_double_in_every_direction, ()) {
  const int d = *rc::gen::inRange(1, 4);
  const apsis::velocity_grid grid = any_grid(d);
  row g;
  for (int j = 0; j < grid.size(); ++j) g.push_back(number(0.0, 1.0));
  const std::array<double, 3> u = {number(-2.0, 2.0), d > 1 ? number(-2.0, 2.0) : 0.0,
                                   d > 2 ? number(-2.0, 2.0) : 0.0};
  const int degree = *rc::gen::inRange(0, apsis::central_sums::highest_degree + 1);
  for_each_instruction_set([&] {
    const apsis::central_sums sums(grid, g.data(), u.data(), degree);
    const auto most = static_cast<std::size_t>(degree);
    for (std::size_t a = 0; a <= most; ++a)
      for (std::size_t b = 0; a + b <= (d > 1 ? most : a); ++b)
        for (std::size_t c = 0; a + b + c <= (d > 2 ? most : a + b); ++c) {
          long double exact = 0, size = 0;
          for (std::size_t j = 0; j < g.size(); ++j) {
            long double term = static_cast<long double>(grid.set().weights()[j]) * g[j];
            const std::array<std::size_t, 3> powers = {a, b, c};
            for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k)
              for (std::size_t p = 0; p < powers[k]; ++p)
                term *= static_cast<long double>(grid.component(static_cast<int>(k))[j]) - u[k];
            exact += term;
            size += std::abs(term);
          }
          // A term is part of about 15 roundings, and of one more for each addition above it.
          RC_ASSERT(std::abs(static_cast<long double>(sums[{a, b, c}]) - exact) <= 8e-15L * size);
        }
  });
}

/// The base is not a product of lines. With the ratio θ of h and g its target needs no pass over the row to
/// restore its moments. Without θ the target is iterated. Both targets must agree.
RC_GTEST_PROP(central_sums, make_targets_conservative, ()) {
  const int d = *rc::gen::inRange(1, 4);
  auto parts = apsis::default_config(apsis::find_model("es-bgk"));
  parts.parameters["velocity_dimensions"] = d;
  parts.velocity.max = 7.0;
  parts.velocity.points = d == 3 ? 14 : 20;
  const apsis::gas of(parts);
  apsis::fluid_state state;
  state.rho = number(0.1, 3.0);
  state.T = number(0.7, 1.3);
  Eigen::MatrixXd deviation(d, d);
  for (int k = 0; k < d; ++k) {
    state.u[k] = number(-1.0, 1.0);
    for (int l = 0; l <= k; ++l) deviation(k, l) = deviation(l, k) = 0.2 * state.T * number(-1.0, 1.0);
  }
  if (d == 3) deviation -= deviation.trace() / 3.0 * Eigen::MatrixXd::Identity(d, d);
  const Eigen::MatrixXd covariance = state.T * Eigen::MatrixXd::Identity(d, d) + deviation,
                        inverse = covariance.inverse();
  apsis::direction_matrix plain{}, plain_inverse{};
  apsis::target_shape shape;
  shape.variance = covariance.trace() / d;
  for (int k = 0; k < d; ++k)
    for (int l = 0; l < d; ++l) {
      plain.of[k][l] = covariance(k, l);
      plain_inverse.of[k][l] = inverse(k, l);
      shape.of_g.a[k][l] = shape.of_h.a[k][l] = 0.05 * deviation(k, l);
    }
  const auto size = static_cast<std::size_t>(of.velocities().components());
  const double others = 3.0 * state.T - covariance.trace();
  row base(size), known(size), iterated(size);
  apsis::correlated_gaussian(of.grid(), state, plain, plain_inverse, base.data());
  if (of.reduced()) of.fill_h(others, base.data());
  std::array<double, 5> omega{}, own{};
  omega[0] = state.rho;
  double square = 3.0 * state.T;
  for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) {
    omega[1 + k] = state.rho * state.u[k];
    square += state.u[k] * state.u[k];
  }
  omega[static_cast<std::size_t>(d) + 1] = 0.5 * state.rho * square;
  const double infinity = std::numeric_limits<double>::infinity();
  bool raised = false;
  RC_ASSERT(apsis::conservative_target(of, omega.data(), {base.data(), {}, others}, shape, base.data(),
                                       infinity, known.data(), raised));
  of.moments(known.data(), 0, 1, own.data());
  for (std::size_t k = 0; k < 5; ++k)
    RC_ASSERT(std::abs(own[k] - omega[k]) <=
              apsis::target_accuracy * (omega[0] + omega[static_cast<std::size_t>(d) + 1]));
  if (!of.reduced()) return;
  RC_ASSERT(apsis::conservative_target(of, omega.data(), {base.data(), {}}, shape, base.data(), infinity,
                                       iterated.data(), raised));
  RC_ASSERT(!raised);
  const double largest = *std::max_element(base.begin(), base.end());
  for (std::size_t j = 0; j < size; ++j) RC_ASSERT(std::abs(known[j] - iterated[j]) < 1e-13 * largest);
}

}  // namespace central_sums_test
