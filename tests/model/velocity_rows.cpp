// Sums and Gaussians over velocity points agree with long double in every instruction set.
#include <apsis/model/velocity_rows.hpp>

#include <apsis/model/maxwellian.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <support/instruction_sets.hpp>

namespace velocity_rows_test {

namespace {

/// Returns the distance relative to the exact value.
double relative(double value, long double exact) {
  return static_cast<double>(std::abs((static_cast<long double>(value) - exact) / exact));
}

}  // namespace

TEST(velocity_rows, sums_are_those_of_long_double) {
  for_each_instruction_set([] {
    for (const int n : {1, 4, 7, 8, 23, 150, 1000}) {
      std::vector<double> f, v, half;
      long double mass = 0, momentum = 0, energy = 0, size = 0;
      for (int j = 0; j < n; ++j) {
        v.push_back(30.0 * (j + 0.5) / n - 15.0);
        half.push_back(0.5 * v.back() * v.back());
        f.push_back(j % 9 == 0 ? 0.0 : (2.0 + std::sin(j)) * std::exp(-half.back()));
        const long double value = f.back();
        mass += value;
        momentum += v.back() * value;
        energy += half.back() * value;
        size += std::abs(v.back()) * value;
      }
      apsis::velocity_rows::sums sums{};
      apsis::velocity_rows::moments(f.data(), 0, 1, v.data(), half.data(), n, &sums);
      // Partial sums of nonnegative terms have at most n/8 rounding errors.
      const double rounding = 1e-16 * (8.0 + n / 4.0);
      EXPECT_NEAR(sums.mass, static_cast<double>(mass), rounding * static_cast<double>(mass)) << n;
      EXPECT_NEAR(sums.momentum, static_cast<double>(momentum), rounding * static_cast<double>(size)) << n;
      EXPECT_NEAR(sums.energy, static_cast<double>(energy), rounding * static_cast<double>(energy)) << n;
    }
  });
}

TEST(velocity_rows, a_gaussian_is_accurate_for_every_centre_and_width) {
  for_each_instruction_set([] {
    for (const int n : {4, 13, 150, 151})
      for (const double T : {0.003, 0.05, 1.0, 30.0})
        for (const double u : {0.0, 0.3, -14.9, 15.0, -40.0, 200.0}) {
          const apsis::velocity_rows::points line{n, 30.0 / n};
          std::vector<double> m(static_cast<std::size_t>(n) + 1, -7.0);
          const apsis::velocity_rows::gaussian of_row{2.0, u, T};
          apsis::velocity_rows::gaussians(line, &of_row, 1, m.data(), 0);
          EXPECT_EQ(m.back(), -7.0) << "memory after the row is left alone";
          const auto exact = [&](int j) {
            const long double x = 0.5L * line.spacing * (2.0L * j + 1 - n) - u;
            return 2 * std::exp(-x * x / (2 * T));
          };
          long double largest = 0;
          for (int j = 0; j < n; ++j) largest = std::max(largest, exact(j));
          for (int j = 0; j < n; ++j) {
            const double value = m[static_cast<std::size_t>(j)];
            if (exact(j) < 1e-299L) {
              EXPECT_LT(value, 2e-299) << u << " " << T;
              EXPECT_GE(value, 0.0);
            } else {
              // The exponential of a rounded argument x < 700 has a relative error of about 1e-16 (1 + x).
              EXPECT_LT(relative(value, exact(j)), 1e-12) << n << " " << u << " " << T << " " << j;
              // The difference v − u has the rounding errors of v and u. The exponent amplifies them.
              const double v = 0.5 * line.spacing * (2.0 * j + 1 - n);
              const double moved = 3e-16 * (std::abs(v) + std::abs(u)) * std::abs(v - u) / T;
              const double exponent = static_cast<double>(-std::log(largest / 2));
              EXPECT_NEAR(value, static_cast<double>(exact(j)),
                          (6e-15 + 4e-16 * exponent) * static_cast<double>(largest) +
                              moved * static_cast<double>(exact(j)))
                  << n << " " << u << " " << T << " " << j;
            }
          }
        }
  });
}

/// There are eight chains, and walks by eight velocities, for any length of a vector. Instruction sets
/// without fused operations round once more.
TEST(velocity_rows, sums_and_gaussians_have_the_same_bits_on_every_instruction_set_with_fused_operations) {
  for (const int n : {5, 8, 40, 45, 150, 151, 700}) {
    const apsis::velocity_rows::points line{n, 16.0 / n};
    const std::vector<apsis::velocity_rows::gaussian> curves = {
        {2.0, 0.3, 1.0}, {1.0, -5.0, 0.2}, {1e-40, 7.0, 0.01}, {3.0, 0.0, 30.0}, {1.0, 2.5, 1e-4}};
    const auto rows = curves.size(), pitch = static_cast<std::size_t>(n) + 8;
    std::vector<double> v, half;
    for (int j = 0; j < n; ++j) {
      v.push_back(line.spacing * (j + 0.5 - 0.5 * n));
      half.push_back(0.5 * v.back() * v.back());
    }
    std::vector<std::vector<double>> found;
    for_each_instruction_set([&] {
      if (hwy::SupportedTargets() > HWY_AVX2) return;  // smaller numbers denote better instruction sets
      std::vector<double> numbers(rows * pitch);
      apsis::velocity_rows::gaussians(line, curves.data(), static_cast<int>(rows), numbers.data(),
                                      static_cast<std::ptrdiff_t>(pitch));
      std::vector<apsis::velocity_rows::sums> sums(rows);
      apsis::velocity_rows::moments(numbers.data(), static_cast<std::ptrdiff_t>(pitch),
                                    static_cast<int>(rows), v.data(), half.data(), n, sums.data());
      for (const auto& one : sums) numbers.insert(numbers.end(), {one.mass, one.momentum, one.energy});
      found.push_back(std::move(numbers));
    });
    for (const auto& one : found) EXPECT_EQ(one, found.front()) << n << " velocities";
  }
}

TEST(velocity_rows, batches_of_rows_give_the_bits_of_single_rows) {
  for_each_instruction_set([] {
    for (const int n : {5, 150})
      for (const int rows : {1, 2, 3, 7, 8, 9, 20}) {
        const apsis::velocity_rows::points line{n, 20.0 / n};
        const std::ptrdiff_t pitch = n + 3;
        std::vector<apsis::velocity_rows::gaussian> of;
        for (int p = 0; p < rows; ++p) of.push_back({1.0 + p, 3.0 * std::sin(p), 0.01 * std::exp(0.5 * p)});
        std::vector<double> m(static_cast<std::size_t>(rows * pitch), -7.0), one(static_cast<std::size_t>(n)),
            v(one.size(), 0.3), half(one.size(), 0.7);
        apsis::velocity_rows::gaussians(line, of.data(), rows, m.data(), pitch);
        std::vector<apsis::velocity_rows::sums> sums(of.size());
        apsis::velocity_rows::moments(m.data(), pitch, rows, v.data(), half.data(), n, sums.data());
        for (int p = 0; p < rows; ++p) {
          const auto k = static_cast<std::size_t>(p);
          const double* row = m.data() + p * pitch;
          apsis::velocity_rows::gaussians(line, &of[k], 1, one.data(), 0);
          EXPECT_TRUE(std::equal(one.begin(), one.end(), row)) << n << " " << rows << " " << p;
          EXPECT_EQ(row[n], -7.0) << "padding between the rows is left alone";
          apsis::velocity_rows::sums alone{};
          apsis::velocity_rows::moments(row, 0, 1, v.data(), half.data(), n, &alone);
          EXPECT_EQ(alone.mass, sums[k].mass);
          EXPECT_EQ(alone.momentum, sums[k].momentum);
          EXPECT_EQ(alone.energy, sums[k].energy);
        }
      }
  });
}

TEST(velocity_rows, moments_of_the_formula_are_exact_where_claimed) {
  const apsis::velocity_grid grid(1, 150, 15.0);
  int exact = 0, other = 0;
  std::vector<double> m(150);
  for (double T = 0.005; T < 30.0; T *= 1.3)
    for (const double u : {0.0, 1.0, -5.0, 11.0}) {
      const apsis::fluid_state state{1.0, {u, 0.0, 0.0}, T};
      const double omega[3] = {1.0, u, 0.5 * (u * u + T)};
      if (!apsis::formula_has_exact_moments(grid, state)) {
        ++other;
        continue;
      }
      ++exact;
      apsis::formula_maxwellian(grid, state, m.data());
      // The tolerance covers the rounding error of a sum of 150 terms, relative to (ρ, ρ√T, ρT).
      EXPECT_LT(apsis::moment_defect(grid, m.data(), omega, state), 4e-14) << u << " " << T;
    }
  EXPECT_GT(exact, 20);
  EXPECT_GT(other, 20);
}

}  // namespace velocity_rows_test
