// Loops over the rows of cut cells have the bits of their formulas on single numbers.
#include <apsis/semidiscrete/cut_rows.hpp>
#include <apsis/semidiscrete/formulas/cut_cell.hpp>

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <semidiscrete/number_rows.hpp>
#include <support/property.hpp>
#include <support/reference_numbers.hpp>

namespace semidiscrete_formulas_test {
namespace scalar = apsis::scalar;

TEST(cut_rows, are_the_formulas_of_single_numbers) {
  namespace cut_rows = apsis::cut_rows;
  random_source random(11);
  for (int k = 0; k < 200; ++k) {
    const auto n = static_cast<std::size_t>(1 + k % 19);
    const rows u(2, n, random, any_size), v(2, n, random, any_sign);
    rows slopes(2, n, random, any_sign), beyond(2, n, random, any_sign);
    std::vector<double> plain(2 * n), steady(2 * n), share(n), values(n, 7.0), alone(n), to_row(n, 0.5),
        to_both(n, 0.5);
    const rows around(2, n, random, any_size);
    const std::array<cut_rows::neighbour, 2> neighbours = {
        {{around.at[0], {0.7, -0.1, 0.0}}, {around.at[1], {-0.2, 0.4, 0.0}}}};
    const bool limited = k % 2 == 0;
    const std::array<std::array<double, 3>, 2> to = {{{0.3, -0.2, 0.0}, {-0.4, 0.1, 0.0}}};
    const auto way_at = [&](std::size_t face) {
      return cut_rows::way_out{{0.6, face == 0 ? 0.8 : -0.8, 0.0}, 1.5, {v.at[0], v.at[1], nullptr}};
    };
    const auto line_to = [&](std::size_t face) {
      return cut_rows::line{u.at[0], {slopes.all.data(), slopes.all.data() + n, nullptr}, to[face], limited};
    };
    const cut_rows::line other{
        u.at[1], {beyond.all.data(), beyond.all.data() + n, nullptr}, {0.2, 0.7, 0.0}, limited};
    const cut_rows::extent of{2, static_cast<int>(n)};
    constexpr double step = 0.01;
    const auto kept = drawn(n, random, [](random_source& r) { return r.uniform(0.8, 1.0); });
    const std::array<cut_rows::outlet, 2> outlets = {{{way_at(0), to[0]}, {way_at(1), to[1]}}};
    cut_rows::fit(u.at[0], neighbours, of, {plain.data(), plain.data() + n, nullptr});
    cut_rows::fit(u.at[0], neighbours, {outlets, step, kept.data(), false}, of, line_to(0).slopes);
    cut_rows::fit(u.at[0], neighbours, {outlets, step, kept.data(), true}, of,
                  {steady.data(), steady.data() + n, nullptr});
    cut_rows::project(way_at(0), of, share.data());
    cut_rows::leave(share.data(), line_to(0), of, values.data());
    cut_rows::leave_alone(way_at(0), line_to(0), of, alone.data());
    const cut_rows::crossing row{way_at(0), to[0], {u.at[1], {}, {}, limited}};
    const cut_rows::crossing lines[] = {{way_at(0), to[0], other}, row};
    cut_rows::pass({&row, 1}, line_to(1), of, to_row.data());
    cut_rows::pass(lines, line_to(1), of, to_both.data());
    for (std::size_t j = 0; j < n; ++j) {
      const auto outward = [&](std::size_t face) {
        return 1.5 * scalar::fma(v.at[1][j], way_at(face).normal[1], v.at[0][j] * 0.6);
      };
      const auto value = [&](double here, double slope_x, double slope_y, const std::array<double, 3>& by) {
        const double correction = scalar::fma(slope_y, by[1], slope_x * by[0]);
        return limited ? scalar::nonnegative_leaving_value(here, correction)
                       : scalar::leaving_value(here, correction);
      };
      const auto slope = [&](std::size_t d) {
        const double first = neighbours[0].weight[d] * (around.at[0][j] - u.at[0][j]);
        return scalar::fma(neighbours[1].weight[d], around.at[1][j] - u.at[0][j], first);
      };
      ASSERT_EQ(plain[j], slope(0));
      ASSERT_EQ(plain[n + j], slope(1));
      scalar::cut_demand<double> sums{0.0, 0.0, 0.0, 0.0};
      for (std::size_t face = 0; face < 2; ++face) {
        const double first = slope(0) * to[face][0], second = slope(1) * to[face][1];
        sums.add(step * outward(face), first + second, std::abs(first) + std::abs(second));
      }
      const double factor = sums.factor(u.at[0][j], kept[j]);
      ASSERT_EQ(slopes.all[j], factor * slope(0));
      ASSERT_EQ(slopes.all[n + j], factor * slope(1));
      const double steady_factor = sums.steady_factor(u.at[0][j], kept[j]);
      ASSERT_EQ(steady[j], steady_factor * slope(0));
      ASSERT_EQ(steady[n + j], steady_factor * slope(1));
      ASSERT_EQ(share[j], outward(0));
      const double leaving = value(u.at[0][j], slopes.all[j], slopes.all[n + j], to[0]),
                   entering = value(u.at[1][j], beyond.all[j], beyond.all[n + j], other.vector);
      const bool leaves = outward(0) > 0.0;
      ASSERT_EQ(values[j], leaves ? leaving : 7.0);
      ASSERT_EQ(alone[j], leaves ? leaving : 0.0);
      ASSERT_EQ(to_row[j], scalar::negative_fma(outward(0), leaves ? leaving : u.at[1][j], 0.5));
      const double first = scalar::negative_fma(outward(0), leaves ? leaving : entering, 0.5);
      ASSERT_EQ(to_both[j], scalar::negative_fma(outward(0), leaves ? leaving : u.at[1][j], first));
    }
  }
}

}  // namespace semidiscrete_formulas_test
