// Sums over all points of a velocity grid agree with long double in every instruction set.
#include <apsis/model/grid_sums.hpp>

#include <apsis/model/maxwellian.hpp>
#include <apsis/velocity/velocity_grid.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <support/instruction_sets.hpp>

namespace grid_sums_test {

namespace {

using apsis::velocity_grid;

/// Returns a grid of lines with different lengths, unequal spacing and weights.
velocity_grid graded(int dimensions) {
  std::vector<apsis::velocity_line> lines;
  for (int k = 0; k < dimensions; ++k) {
    std::vector<double> v, w;
    for (int j = 0; j < 9 + 7 * k; ++j) {
      const double x = j - 4.0 - 3.5 * k + 0.1;
      v.push_back(x * std::sqrt(std::abs(x)));
      w.push_back(1.5 * std::sqrt(std::abs(x)));
    }
    lines.emplace_back(v, w);
  }
  return velocity_grid(std::move(lines));
}

std::vector<double> bumpy_row(const velocity_grid& grid) {
  std::vector<double> f;
  for (int j = 0; j < grid.size(); ++j)
    f.push_back((2.0 + std::sin(j)) * std::exp(-0.3 * grid.half_square()[static_cast<std::size_t>(j)]));
  return f;
}

}  // namespace

TEST(grid_sums, give_the_moments_of_long_double_on_every_grid) {
  for_each_instruction_set([] {
    for (const auto& grid : {graded(1), graded(2), graded(3), velocity_grid(1, 37, 6.0),
                             velocity_grid(2, 21, 6.0), velocity_grid(3, 12, 6.0)}) {
      const auto f = bumpy_row(grid);
      const int d = grid.dimensions();
      std::array<long double, 5> exact{}, size{};
      for (std::size_t j = 0; j < f.size(); ++j) {
        const long double mass = static_cast<long double>(grid.set().weights()[j]) * f[j];
        long double square = 0;
        const auto add = [&](std::size_t k, long double term) {
          exact[k] += term;
          size[k] += std::abs(term);
        };
        add(0, mass);
        for (int k = 0; k < d; ++k) {
          const long double v = grid.component(k)[j];
          square += v * v;
          add(static_cast<std::size_t>(k) + 1, mass * v);
        }
        add(static_cast<std::size_t>(d) + 1, mass * square / 2);
      }
      std::array<double, 5> omega{};
      apsis::kinetic_moments(grid, f.data(), omega.data());
      // A term is part of 5 roundings, and of one more for each addition above it: 16 lines,
      // halves, and chains.
      for (std::size_t k = 0; k < static_cast<std::size_t>(d) + 2; ++k)
        EXPECT_NEAR(omega[k], static_cast<double>(exact[k]), 4e-15 * static_cast<double>(size[k])) << d << k;
      EXPECT_NEAR(apsis::kinetic_mass(grid, f.data()), omega[0], 4e-15 * omega[0]);
    }
  });
}

TEST(grid_sums, of_many_small_terms_beside_large_ones_lose_none) {
  // The sum of 4097 lines is 2 + 4096 · 2^-54. Added one by one, all terms after the first would vanish.
  constexpr int lines = 4097, n = 3;
  std::vector<double> f(lines * n, 0x1p-54), a(lines, 1.0);
  for (int j = 0; j < n; ++j) f[static_cast<std::size_t>(j)] = 2.0;
  const std::vector<double> v = {1.0, 1.0, 1.0};
  for_each_instruction_set([&] {
    apsis::grid_sums::powers sums{};
    apsis::grid_sums::sum({n, v.data(), nullptr}, lines, f.data(), 0.0, a.data(), 1, &sums);
    EXPECT_NEAR(sums[0] / n - 2.0, 4096 * 0x1p-54, 64 * 0x1p-54);  // one chain and 6 roundings may be lost
  });
}

TEST(grid_sums, multiply_lines_and_leave_the_memory_behind_them_alone) {
  for_each_instruction_set([] {
    for (const int n : {1, 3, 8, 13, 16})
      for (const int lines : {1, 2, 5}) {
        const auto size = static_cast<std::size_t>(n) * static_cast<std::size_t>(lines);
        std::vector<double> a(static_cast<std::size_t>(lines)), g(static_cast<std::size_t>(n)),
            m(size + 1, -7.0);
        for (std::size_t l = 0; l < a.size(); ++l) a[l] = 1.0 + static_cast<double>(l);
        for (std::size_t j = 0; j < g.size(); ++j) g[j] = 0.1 + static_cast<double>(j);
        apsis::grid_sums::multiply(a.data(), lines, g.data(), n, m.data());
        for (std::size_t k = 0; k < size; ++k) EXPECT_EQ(m[k], a[k / g.size()] * g[k % g.size()]);
        EXPECT_EQ(m.back(), -7.0);
      }
  });
}

TEST(grid_sums, give_the_entropy_of_long_double) {
  for_each_instruction_set([] {
    for (const int n : {1, 7, 8, 150}) {
      std::vector<double> w, g, h;
      long double f_log_f = 0, both = 0, mass = 0;
      const double degrees = 1.5, least = std::numeric_limits<double>::min();
      for (int j = 0; j < n; ++j) {
        w.push_back(0.5 + 0.01 * j);
        g.push_back(j % 9 == 4 ? 0.0 : (2.0 + std::sin(j)) * std::exp(-0.1 * j));
        h.push_back(j % 5 == 2 ? 0.0 : 0.7 * g.back());
        const long double of_mass = static_cast<long double>(w.back()) * g.back();
        if (g.back() == 0.0) continue;
        mass += of_mass;
        f_log_f += of_mass * std::log(static_cast<long double>(g.back()));
        both += of_mass * degrees * std::log(static_cast<long double>(g.back()) / std::max(h.back(), least));
      }
      // Logarithms are below 710, and accurate to two units in the last place.
      const double rounding = 1e-15 * 710.0 * static_cast<double>(mass);
      EXPECT_NEAR(apsis::grid_sums::entropy(w.data(), g.data(), nullptr, degrees, n),
                  static_cast<double>(f_log_f), rounding);
      EXPECT_NEAR(apsis::grid_sums::entropy(w.data(), g.data(), h.data(), degrees, n),
                  static_cast<double>(f_log_f + both), rounding);
    }
  });
}

}  // namespace grid_sums_test
