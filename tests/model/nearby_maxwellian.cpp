// The discrete Maxwellian near a Gaussian: its form, its moments, and its refusals.
#include <apsis/model/nearby_maxwellian.hpp>

#include <apsis/model/gas_target.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/velocity/gauss_rule.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace nearby_maxwellian_test {

namespace {

using apsis::fluid_state;
using apsis::line_moments;
using apsis::velocity_grid;
using apsis::velocity_line;
using row = apsis::aligned_vector<double>;

/// Returns Gauss points of both half lines, for which no integral of a shifted Gaussian is exact.
velocity_line half_ranges(int of_half) {
  const auto rule = apsis::half_range_gauss_hermite(of_half);
  std::vector<double> points, weights;
  for (std::size_t j = rule.nodes.size(); j-- > 0;) {
    points.push_back(-rule.nodes[j]);
    weights.push_back(rule.weights[j]);
  }
  points.insert(points.end(), rule.nodes.begin(), rule.nodes.end());
  weights.insert(weights.end(), rule.weights.begin(), rule.weights.end());
  return {points, weights};
}

velocity_grid any_grid() {
  const int d = *rc::gen::inRange(1, 4);
  if (*rc::gen::arbitrary<bool>()) return {d, *rc::gen::inRange(10, 30), 6.0};
  std::vector<velocity_line> lines;
  for (int k = 0; k < d; ++k) lines.push_back(half_ranges(*rc::gen::inRange(8, 14)));
  return velocity_grid(std::move(lines));
}

fluid_state any_state(int d) {
  fluid_state s{*rc::gen::inRange(1, 100) * 0.1, {}, *rc::gen::inRange(60, 150) * 0.01};
  for (int k = 0; k < d; ++k) s.u[k] = *rc::gen::inRange(-80, 80) * 0.01;
  return s;
}

/// Returns Σ w m Π_k c_k^p_k in extended precision.
long double moment(const velocity_grid& grid, const row& m, const fluid_state& s, std::array<int, 3> p) {
  long double sum = 0.0L;
  for (std::size_t j = 0; j < m.size(); ++j) {
    long double term = static_cast<long double>(m[j]) * grid.set().weights()[j];
    for (std::size_t k = 0; k < static_cast<std::size_t>(grid.dimensions()); ++k)
      for (int i = 0; i < p[k]; ++i)
        term *= static_cast<long double>(grid.component(static_cast<int>(k))[j]) - s.u[k];
    sum += term;
  }
  return sum;
}

}  // namespace

/// Two conditions define the discrete Maxwellian. It has the moments of the state, and log m is a parabola in
/// v. Along all directions the parabola is the same, except for its linear term.
TEST(nearby_maxwellian, has_the_moments_and_the_form_of_a_discrete_maxwellian) {
  int found = 0;
  rc::check("form", [&] {
    const velocity_grid grid = any_grid();
    const int d = grid.dimensions();
    const fluid_state s = any_state(d);
    row m(static_cast<std::size_t>(grid.size()));
    line_moments of_m;
    if (!apsis::nearby_maxwellian(grid, s, m.data(), &of_m)) return;
    ++found;
    const auto mass = moment(grid, m, s, {});
    RC_ASSERT(std::abs(mass - s.rho) < 4e-15L * s.rho);
    long double square = 0.0L;
    for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k)
      for (std::size_t p = 1; p < line_moments::powers; ++p) {
        std::array<int, 3> powers{};
        powers[k] = static_cast<int>(p);
        const auto exact = moment(grid, m, s, powers);
        if (p == 1) RC_ASSERT(std::abs(exact) < 4e-15L * s.rho * std::sqrt(s.T));
        if (p == 2) square += exact;
        // The tolerance is relative to the largest terms, of size 6^p. Their sums of two dozen terms have
        // rounding errors.
        RC_ASSERT(std::abs(exact / mass - of_m.of[k][p]) < 1e-14L * std::pow(6.0L * std::sqrt(s.T), p));
      }
    RC_ASSERT(std::abs(square - d * s.rho * s.T) < 1e-14L * s.rho * s.T);
    // The difference of log m and that of the Gaussian is γ|v|² + β·v + α with one γ. Three points along each
    // line give γ.
    double gamma[3] = {};
    std::size_t apart = static_cast<std::size_t>(grid.size());
    for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) {
      const auto& v = grid.line(static_cast<int>(k)).v();
      const std::size_t n = v.size(), a = n / 4, b = n / 2, c = 3 * n / 4;
      apart /= n;
      const auto log_at = [&](std::size_t j) { return std::log(m[j * apart]); };
      const double left = (log_at(b) - log_at(a)) / (v[b] - v[a]),
                   right = (log_at(c) - log_at(b)) / (v[c] - v[b]);
      gamma[k] = (right - left) / (v[c] - v[a]);
      // The logarithms are up to 50 and have rounding errors of 1e-14 each.
      if (k > 0) RC_ASSERT(std::abs(gamma[k] - gamma[0]) < 1e-12);
    }
    RC_ASSERT(std::abs(gamma[0] + 0.5 / s.T) < 0.1);
  });
  EXPECT_GT(found, 50) << "otherwise most states were refused";
}

TEST(nearby_maxwellian, is_refused_far_from_a_gaussian) {
  const velocity_grid grid(1, 12, 6.0);
  row m(12);
  // The points are Δv = 1 apart. The Gaussian of T = 0.1 has moments that are wrong by a factor. Beyond u = 5
  // it is cut in two.
  EXPECT_FALSE(apsis::nearby_maxwellian(grid, {1.0, {0.4, 0, 0}, 0.1}, m.data()));
  EXPECT_FALSE(apsis::nearby_maxwellian(grid, {1.0, {5.2, 0, 0}, 1.0}, m.data()));
  EXPECT_FALSE(apsis::nearby_maxwellian(grid, {1e-290, {0, 0, 0}, 1.0}, m.data()));
  EXPECT_TRUE(apsis::nearby_maxwellian(grid, {1.0, {0.4, 0, 0}, 1.0}, m.data()));
}

/// Some cells are too cold or too thin for Newton's method from a Gaussian. They must not disturb their
/// neighbours.
TEST(nearby_maxwellian, rows_of_a_group_have_the_bits_of_single_rows) {
  int refused = 0, by_newton = 0;
  check_property("groups", [&] {
    const velocity_grid grid = any_grid();
    const int d = grid.dimensions();
    const auto size = static_cast<std::size_t>(grid.size()),
               count = static_cast<std::size_t>(*rc::gen::inRange(1, 20));
    std::vector<fluid_state> states(count);
    std::vector<std::array<double, 5>> omega(count);
    row together(count * size), alone(size);
    std::vector<apsis::row_of_state> rows;
    for (std::size_t i = 0; i < count; ++i) {
      auto& s = states[i] = any_state(d);
      if (*rc::gen::inRange(0, 6) == 0) s.T *= 0.05;
      if (*rc::gen::inRange(0, 6) == 0) s.rho = 1e-280;
      double square = d * s.T;
      omega[i][0] = s.rho;
      for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) {
        omega[i][1 + k] = s.rho * s.u[k];
        square += s.u[k] * s.u[k];
      }
      omega[i][static_cast<std::size_t>(d) + 1] = 0.5 * s.rho * square;
      double* const m = together.data() + i * size;
      if (d == 1) apsis::formula_maxwellian(grid, s, m);
      rows.push_back({omega[i].data(), s, m});
    }
    // Between two points the coldest cells have a temperature that no row has. A group ends there.
    const int found = apsis::discrete_maxwellians(grid, rows);
    for (std::size_t i = 0; i < count; ++i) {
      const bool nearby = apsis::nearby_maxwellian(grid, states[i], alone.data());
      const bool exists = nearby || apsis::general_maxwellian(grid, omega[i].data(), alone.data());
      RC_ASSERT(exists == (static_cast<int>(i) != found));
      if (!exists) break;
      ++(nearby ? by_newton : refused);
      for (std::size_t j = 0; j < size; ++j) RC_ASSERT(same_bits(together[i * size + j], alone[j]));
    }
  });
  EXPECT_GT(refused, 50);
  EXPECT_GT(by_newton, 50);
}

TEST(nearby_maxwellian, a_group_ends_before_the_first_row_without_an_equilibrium) {
  const velocity_grid grid(2, 12, 6.0);
  const fluid_state s{1.0, {0.1, 0.2, 0.0}, 1.0};
  const std::array<double, 4> right{1.0, 0.1, 0.2, 1.025}, beyond{1.0, 0.1, 0.2, 100.0};  // |v|²/2 ≤ 36
  std::vector<row> m(6, row(static_cast<std::size_t>(grid.size())));
  std::vector<apsis::row_of_state> rows;
  for (std::size_t i = 0; i < m.size(); ++i) {
    const bool wrong = i == 4;
    rows.push_back({wrong ? beyond.data() : right.data(), wrong ? apsis::to_fluid_state(beyond.data(), 2) : s,
                    m[i].data()});
  }
  EXPECT_EQ(apsis::discrete_maxwellians(grid, rows), 4);
  EXPECT_EQ(apsis::discrete_maxwellians(grid, std::span(rows).first(4)), 4);
  EXPECT_EQ(apsis::discrete_maxwellians(grid, {}), 0);
}

TEST(nearby_maxwellian, is_the_row_of_the_general_method) {
  rc::check("both", [] {
    const velocity_grid grid = any_grid();
    const fluid_state s = any_state(grid.dimensions());
    std::array<double, 5> omega{};
    double square = grid.dimensions() * s.T;
    omega[0] = s.rho;
    for (std::size_t k = 0; k < static_cast<std::size_t>(grid.dimensions()); ++k) {
      omega[1 + k] = s.rho * s.u[k];
      square += s.u[k] * s.u[k];
    }
    omega[static_cast<std::size_t>(grid.dimensions()) + 1] = 0.5 * s.rho * square;
    row nearby(static_cast<std::size_t>(grid.size())), general(nearby.size());
    RC_PRE(apsis::nearby_maxwellian(grid, s, nearby.data()));
    RC_ASSERT(apsis::general_maxwellian(grid, omega.data(), general.data()));
    const double largest = *std::max_element(general.begin(), general.end());
    // The parameters have relative errors of 1e-14. Their exponents are at most 10 where values matter.
    for (std::size_t j = 0; j < nearby.size(); ++j)
      RC_ASSERT(std::abs(nearby[j] - general[j]) < 1e-12 * largest);
  });
}

/// With the moments of lines a target needs no pass over the row to restore its moments. Without them it is
/// iterated. Both targets must agree.
TEST(nearby_maxwellian, targets_by_moments_of_lines_are_those_by_iteration) {
  for (int d = 1; d <= 3; ++d) {
    auto parts = apsis::default_config(apsis::find_model("shakhov"));
    parts.parameters["velocity_dimensions"] = d;
    parts.velocity.max = 6.0;
    parts.velocity.points = 12;
    const apsis::gas of(parts);
    const auto size = static_cast<std::size_t>(of.velocities().components());
    rc::check("targets", [&] {
      const fluid_state s = any_state(d);
      std::array<double, 5> omega{};
      double square = 3.0 * s.T;
      omega[0] = s.rho;
      for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) {
        omega[1 + k] = s.rho * s.u[k];
        square += s.u[k] * s.u[k];
      }
      omega[static_cast<std::size_t>(d) + 1] = 0.5 * s.rho * square;
      row base(size), known(size), iterated(size);
      apsis::target_base with{base.data(), {}};
      RC_ASSERT(of.equilibrium(omega.data(), base.data(), with.moments));
      RC_PRE(with.moments.known);
      apsis::target_shape shape;
      shape.variance = s.T;
      for (std::size_t k = 0; k < static_cast<std::size_t>(d); ++k) {
        const double q = *rc::gen::inRange(-10, 10) * 0.01;
        shape.of_g.l[k] = -(d + 2.0) * q;
        shape.of_h.l[k] = -static_cast<double>(d) * q;
        shape.of_g.w[k] = shape.of_h.w[k] = q / s.T;
      }
      bool raised = false;
      const double infinity = std::numeric_limits<double>::infinity();
      RC_ASSERT(apsis::conservative_target(of, omega.data(), with, shape, base.data(), infinity, known.data(),
                                           raised));
      RC_ASSERT(apsis::conservative_target(of, omega.data(), {base.data(), {}}, shape, base.data(), infinity,
                                           iterated.data(), raised));
      std::array<double, 5> own{};
      of.moments(known.data(), 0, 1, own.data());
      for (std::size_t k = 0; k < 5; ++k)
        RC_ASSERT(std::abs(own[k] - omega[k]) <= 1e-14 * (omega[0] + omega[static_cast<std::size_t>(d) + 1]));
      const double largest = *std::max_element(base.begin(), base.end());
      for (std::size_t j = 0; j < size; ++j) RC_ASSERT(std::abs(known[j] - iterated[j]) < 1e-13 * largest);
    });
  }
}

}  // namespace nearby_maxwellian_test
