// The discrete Maxwellian, up to the boundary of the realizable moments and in a vacuum.
#include <apsis/core/random_source.hpp>
#include <apsis/model/maxwellian.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace discrete_maxwellian_test {

namespace {

using apsis::random_source;
using apsis::velocity_grid;
using row = apsis::aligned_vector<double>;

row zeros(const velocity_grid& grid) {
  return row(static_cast<std::size_t>(grid.size()), 0.0);
}

std::array<double, 5> moments_of(const velocity_grid& grid, const row& f) {
  std::array<double, 5> omega{};
  apsis::kinetic_moments(grid, f.data(), omega.data());
  return omega;
}

velocity_grid random_grid(random_source& random) {
  const int d = random.integer(1, 4);
  return {d, random.integer(4, d == 1 ? 60 : d == 2 ? 16 : 10), random.magnitude(-1, 2)};
}

/// Returns a row with one to four values of very different magnitudes.
row few_values(const velocity_grid& grid, random_source& random) {
  row f = zeros(grid);
  for (int left = random.integer(1, 5); left > 0; --left)
    f[static_cast<std::size_t>(random.integer(0, grid.size()))] =
        random.uniform(1e-3, 1.0) * (random.one_in(3) ? 1e-12 : 1.0);
  return f;
}

/// Returns an arbitrary point, a grid point, a midpoint, or a point close to one of these.
double random_centre(const velocity_grid& grid, random_source& random) {
  if (random.one_in(3)) return random.uniform(-grid.max(), grid.max());
  const double point = grid.line(0).v()[static_cast<std::size_t>(random.integer(0, grid.line(0).points()))];
  const double nearly = random.one_in(2) ? 1.0 : 1.0 + random.magnitude(-18, -1);
  return point + (random.one_in(2) ? 0.0 : 0.5 * grid.line(0).spacing() * nearly);
}

/// Returns exp(∓|v − u|²/(2T)) with T from 1e-6 Δv² to `hottest` Δv². With the lower sign the mass
/// concentrates at the corners.
row gaussian(const velocity_grid& grid, random_source& random, double hottest, bool inverted) {
  const double T =
      random.magnitude(-6, std::log10(hottest)) * grid.line(0).spacing() * grid.line(0).spacing();
  row exponent = zeros(grid);
  for (int k = 0; k < grid.dimensions(); ++k) {
    const double u = random_centre(grid, random);
    for (std::size_t j = 0; j < exponent.size(); ++j) {
      const double x = grid.component(k)[j] - u;
      exponent[j] += (inverted ? 0.5 : -0.5) * x * x / T;
    }
  }
  const double largest = *std::max_element(exponent.begin(), exponent.end());
  for (double& x : exponent) x = std::exp(x - largest);
  return exponent;
}

/// Returns two adjacent velocities in each direction, plus a tiny amount elsewhere.
row nearly_on_a_face(const velocity_grid& grid, random_source& random) {
  row f(static_cast<std::size_t>(grid.size()), 1.0);
  for (int k = 0; k < grid.dimensions(); ++k) {
    const double first =
        grid.line(0).v()[static_cast<std::size_t>(random.integer(0, grid.line(0).points() - 1))];
    const double share = random.one_in(4) ? random.magnitude(-17, 0) : random.uniform();
    for (std::size_t j = 0; j < f.size(); ++j) {
      const double steps = (grid.component(k)[j] - first) / grid.line(0).spacing();
      f[j] *= std::abs(steps) < 0.5 ? 1.0 - share : std::abs(steps - 1.0) < 0.5 ? share : 0.0;
    }
  }
  f[static_cast<std::size_t>(random.integer(0, grid.size()))] += random.magnitude(-17, 0);
  return f;
}

row random_row(const velocity_grid& grid, random_source& random) {
  row f;
  switch (random.integer(0, 5)) {
    case 0:
      f = few_values(grid, random);
      break;
    case 1:
      f = gaussian(grid, random, 100.0, false);
      break;
    case 2:
      f = nearly_on_a_face(grid, random);
      break;
    default:
      f = gaussian(grid, random, 1e6, random.one_in(2));
  }
  double mass = 0.0;
  for (const double x : f) mass += x;
  const double rho = random.one_in(2) ? 1.0 : random.magnitude(-300, 290);
  for (double& x : f) x *= rho / mass;
  return f;
}

/// Returns the largest defect of the moments of m, summed in extended precision. Defects are relative to the
/// mass, to √(2ρ𝓔) ≥ Σ|v|m, and to the energy. The scale of the energy includes the rounding error of one
/// spacing, for a gas at rest with T = 0.
double defect(const velocity_grid& grid, const row& m, const std::array<double, 5>& omega) {
  const auto d = static_cast<std::size_t>(grid.dimensions());
  std::array<long double, 5> own{};
  for (std::size_t j = 0; j < m.size(); ++j) {
    const long double x = m[j];
    own[0] += x;
    for (std::size_t k = 0; k < d; ++k) own[1 + k] += x * grid.component(static_cast<int>(k))[j];
    own[1 + d] += x * grid.half_square()[j];
  }
  const double speed = std::sqrt(2.0 * omega[1 + d] / omega[0]);
  const auto miss = [&](std::size_t k, double scale) {
    const auto exact = static_cast<long double>(omega[k]);
    const long double off = std::abs(own[k] * static_cast<long double>(grid.weight()) - exact);
    return off == 0.0L ? 0.0 : static_cast<double>(off / static_cast<long double>(scale));
  };
  double worst = miss(0, omega[0]);
  for (std::size_t k = 1; k <= d; ++k) worst = std::max(worst, miss(k, omega[0] * speed));
  const double grain = 1e-16 * omega[0] * grid.line(0).spacing() * grid.line(0).spacing();
  return std::max(worst, miss(1 + d, omega[1 + d] + grain));
}

/// Returns Σ m log(m Δv^d/ρ), which does not depend on the unit of m.
double entropy(const velocity_grid& grid, const row& m, double rho) {
  double sum = 0.0;
  for (const double x : m)
    if (x > 0.0) sum += x / rho * (std::log(x) - std::log(rho) + std::log(grid.weight()));
  return sum * grid.weight();
}

}  // namespace

TEST(discrete_maxwellian, exists_for_the_moments_of_every_nonnegative_row) {
  random_source random(1);
  for (int sample = 0; sample < 100'000; ++sample) {
    const velocity_grid grid = random_grid(random);
    const row f = random_row(grid, random);
    const auto omega = moments_of(grid, f);
    row m = zeros(grid);
    ASSERT_TRUE(apsis::discrete_maxwellian(grid, omega.data(), m.data()))
        << sample << ": " << apsis::why_unrealizable(grid, omega.data());
    for (const double x : m) ASSERT_GE(x, 0.0) << sample;
    // The tolerance covers about ten rounding errors: of the sums of f over up to 1000 points, of a division,
    // and of m.
    ASSERT_LE(defect(grid, m, omega), 2e-14) << sample << ", d = " << grid.dimensions();
    // m minimizes the entropy among the rows with these moments, such as f.
    ASSERT_LE(entropy(grid, m, omega[0]), entropy(grid, f, omega[0]) + 1e-9) << sample;
  }
}

TEST(discrete_maxwellian, has_the_given_moments_near_a_corner_of_the_grid) {
  // Nearly all mass is at one end. During the iteration the weights at the other end pass
  // through subnormal numbers.
  for (const int points : {28, 30, 55}) {
    const velocity_grid grid(1, points, 1.0);
    for (double share = 1e-14; share < 1e-6; share *= 1.5)
      for (const int other : {0, 1, points / 2, points - 2}) {
        row f = zeros(grid), m = zeros(grid);
        f.back() = 1.0 - share;
        f[static_cast<std::size_t>(other)] = share;
        const auto omega = moments_of(grid, f);
        ASSERT_TRUE(apsis::discrete_maxwellian(grid, omega.data(), m.data()));
        EXPECT_LE(defect(grid, m, omega), 2e-14) << points << " " << share << " " << other;
      }
  }
}

TEST(discrete_maxwellian, of_a_row_on_one_velocity_or_two_adjacent_ones_is_that_row) {
  random_source random(2);
  for (int sample = 0; sample < 2000; ++sample) {
    const velocity_grid grid(1, random.integer(4, 60), random.magnitude(-1, 3));
    const auto first = static_cast<std::size_t>(random.integer(0, grid.line(0).points() - 1));
    row f = zeros(grid), m = zeros(grid);
    f[first] = random.one_in(3) ? 0.0 : random.magnitude(-20, 0);
    f[first + 1] = random.one_in(3) && f[first] > 0.0 ? 0.0 : random.magnitude(-20, 0);
    const auto omega = moments_of(grid, f);
    ASSERT_TRUE(apsis::discrete_maxwellian(grid, omega.data(), m.data())) << sample;
    // Moments are rounded relative to the energy. It may be that of many spacings.
    const double rounding = 1e-15 * (f[first] + f[first + 1]) * grid.line(0).points() * grid.line(0).points();
    for (std::size_t j = 0; j < m.size(); ++j) ASSERT_NEAR(m[j], f[j], rounding) << sample;
  }
}

TEST(discrete_maxwellian, on_a_face_is_the_product_of_its_lines) {
  // With the smallest energy, means between two adjacent points in each direction belong to 2^d points. With
  // the largest energy of the grid the same means belong to its 2^d corners.
  for (int d = 1; d <= 3; ++d) {
    const velocity_grid grid(d, 6, 3.0);
    for (const bool lower : {true, false}) {
      const double low = lower ? -0.5 : -2.5, high = lower ? 0.5 : 2.5;
      const std::array<double, 3> share = {0.3, 0.5, 0.9};
      row expected(static_cast<std::size_t>(grid.size()), 1.0), m = zeros(grid);
      for (int k = 0; k < d; ++k)
        for (std::size_t j = 0; j < expected.size(); ++j) {
          const double v = grid.component(k)[j], s = share[static_cast<std::size_t>(k)];
          expected[j] *= v == high ? s : v == low ? 1.0 - s : 0.0;
        }
      // With maximal correlation the marginals are the same, but as much mass as possible is on the diagonal.
      row f = zeros(grid);
      double placed = 0.0;
      std::array<double, 3> sorted = share;
      std::sort(sorted.begin(), sorted.begin() + d);
      const auto index_of = [&](double upto) {
        for (std::size_t j = 0; j < f.size(); ++j) {
          bool found = true;
          for (int k = 0; k < d; ++k)
            found = found && grid.component(k)[j] == (share[static_cast<std::size_t>(k)] > upto ? high : low);
          if (found) return j;
        }
        return f.size();
      };
      for (int k = 0; k <= d; ++k) {
        const double next = k < d ? sorted[static_cast<std::size_t>(k)] : 1.0;
        f[index_of(placed)] += next - placed;
        placed = next;
      }
      const auto omega = moments_of(grid, f);
      ASSERT_TRUE(apsis::discrete_maxwellian(grid, omega.data(), m.data()));
      // A rounding error ε of the energy moves a share of a few ε of the mass to other velocities.
      for (std::size_t j = 0; j < m.size(); ++j) EXPECT_NEAR(m[j], expected[j], 1e-14) << d << lower;
    }
  }
}

TEST(discrete_maxwellian, depends_continuously_on_the_moments_up_to_the_boundary) {
  // The steps from T = 0, at and between grid points, have increasing size. |Δm| ≤ C |Δω| with C
  // of order 1/Δv².
  for (const double u : {0.5, 0.0, 0.3, 2.5, 5.4999999999}) {
    const velocity_grid grid(1, 12, 6.0);
    const double distance = std::abs(u - std::floor(u) - 0.5);
    const double coldest = distance * (1.0 - distance);
    const double most = std::min(1e-3, (5.5 - u) * (5.5 + u) - coldest);
    row previous = zeros(grid), next = zeros(grid);
    double before = 0.0;
    for (double excess = 0.0; excess < most; excess = excess == 0.0 ? 1e-18 : 3.0 * excess) {
      ASSERT_TRUE(apsis::discrete_maxwellian(grid, {1.0, {u, 0, 0}, coldest + excess}, next.data()));
      double change = 0.0;
      for (std::size_t j = 0; j < next.size(); ++j) change += std::abs(next[j] - previous[j]);
      // u² + T is rounded to 1e-15 · 36.
      if (excess > 0.0) {
        EXPECT_LE(change, 4.0 * (excess - before) + 2e-13) << u << " " << excess;
      }
      std::swap(previous, next);
      before = excess;
    }
  }
}

TEST(discrete_maxwellian, exists_for_vacuum_and_for_subnormal_rows) {
  random_source random(3);
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  for (int d = 1; d <= 3; ++d) {
    const velocity_grid grid(d, 9, 4.0);
    row f = zeros(grid), m(f.size(), 1.0);
    auto omega = moments_of(grid, f);
    ASSERT_TRUE(apsis::discrete_maxwellian(grid, omega.data(), m.data()));
    EXPECT_EQ(m, f);
    for (int sample = 0; sample < 2000; ++sample) {
      for (double& x : f) x = random.one_in(3) ? std::floor(random.magnitude(0, 14)) * smallest : 0.0;
      omega = moments_of(grid, f);
      ASSERT_TRUE(apsis::discrete_maxwellian(grid, omega.data(), m.data())) << sample;
      double mass = 0.0;
      for (const double x : m) {
        ASSERT_GE(x, 0.0);
        mass += grid.weight() * x;
      }
      // Every value is rounded to a multiple of the smallest subnormal number.
      ASSERT_NEAR(mass, omega[0], static_cast<double>(f.size()) * smallest + 1e-14 * omega[0]) << sample;
    }
  }
}

TEST(discrete_maxwellian, reports_why_moments_are_not_realizable) {
  const velocity_grid grid(2, 10, 5.0);
  row m = zeros(grid);
  const auto why = [&](std::array<double, 4> omega) {
    EXPECT_FALSE(apsis::discrete_maxwellian(grid, omega.data(), m.data()));
    return apsis::why_unrealizable(grid, omega.data());
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(why({nan, 0, 0, 1}), "density is not finite");
  EXPECT_EQ(why({1, nan, 0, 1}), "a moment is not finite");
  EXPECT_EQ(why({-1, 0, 0, 1}), "density -1 is not positive");
  EXPECT_EQ(why({0, 0, 0, 1}), "density 0 is not positive");
  EXPECT_EQ(why({1, 2, 0, 1}), "temperature -1 is not positive");
  EXPECT_EQ(why({1, 0, 4.7, 12}), "bulk velocity 4.7 lies beyond the last point 4.5 of the velocity grid");
  EXPECT_EQ(
      why({1, 0, 0, 0.1}),
      "temperature 0.1 is below 0.25, the least that f >= 0 has on a velocity grid of spacing 1 at this "
      "bulk velocity");
  EXPECT_EQ(why({1, 0, 0, 21}),
            "temperature 21 is above 20.25, the largest that f >= 0 has on the velocity grid at this bulk "
            "velocity");
  const std::array<double, 4> fine = {1, 0, 0, 1};
  EXPECT_EQ(apsis::why_unrealizable(grid, fine.data()), "");
}

}  // namespace discrete_maxwellian_test
