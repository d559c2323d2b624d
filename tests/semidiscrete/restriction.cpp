// Unknowns of a finer mesh on a coarser one, in one, two and three dimensions.
#include <apsis/core/index.hpp>
#include <apsis/semidiscrete/cell_unknown.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <support/property.hpp>

namespace restriction_test {

namespace {

using apsis::at;
using apsis::cell_unknown;
using apsis::grid;
using apsis::position;

constexpr std::array<bool, 3> closed = {false, false, false};

grid box(int dimensions, std::array<int, 3> cells) {
  return grid(dimensions, cells, {0, -1, 2}, {2, 2, 3});
}

/// Two components, f and 2f, at the centres of all cells; NaN inside solid boxes.
std::vector<double> at_centres(const grid& mesh, const std::function<double(const position&)>& f) {
  std::vector<double> values;
  for (int cell = 0; cell < mesh.size(); ++cell) {
    const double value =
        mesh.solid(cell) < 0 ? f(mesh.centre(cell)) : std::numeric_limits<double>::quiet_NaN();
    values.insert(values.end(), {value, 2.0 * value});
  }
  return values;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = a.size() == b.size() ? 0.0 : HUGE_VAL;
  for (std::size_t k = 0; k < a.size() && k < b.size(); ++k)
    // NaN marks cells in boxes, which become 0.
    largest = std::max(largest, std::isnan(b[k]) ? std::abs(a[k]) : std::abs(a[k] - b[k]));
  return largest;
}

}  // namespace

TEST(restriction, of_a_function_linear_in_each_direction_is_exact) {
  const auto f = [](const position& x) { return (1.0 + 2.0 * x[0]) * (3.0 - x[1]) * (0.5 + x[2]); };
  // The ratios differ: 2, 3 and 4.
  const std::array<int, 3> coarse = {5, 4, 3}, fine = {10, 12, 12};
  for (const cell_unknown* unknown : {&apsis::cell_averages(), &apsis::point_values()})
    for (int dimensions = 1; dimensions <= 3; ++dimensions) {
      // The average of such a function is its value at the centre.
      const grid to = box(dimensions, coarse), from = box(dimensions, fine);
      EXPECT_LT(largest_difference(unknown->restricted_to_mesh(at_centres(from, f), 2, from, to, closed),
                                   at_centres(to, f)),
                1e-12)  // values up to 140, and weights of one-sided stencils of some ten
          << unknown->plural() << " in " << dimensions << " dimensions";
    }
}

TEST(restriction, of_averages_is_the_mean_over_the_cells_inside) {
  check_property("mean", [] {
    std::array<int, 3> coarse{}, ratio{}, fine{};
    for (std::size_t k = 0; k < 3; ++k) {
      coarse[k] = *rc::gen::inRange(1, 5);
      ratio[k] = *rc::gen::inRange(1, 4);
      fine[k] = coarse[k] * ratio[k];
    }
    const grid to(3, coarse, {0, 0, 0}, {1, 1, 1}), from(3, fine, {0, 0, 0}, {1, 1, 1});
    const auto values = *rc::gen::container<std::vector<int>>(at(from.size()), rc::gen::inRange(-1000, 1000));
    std::vector<double> sums(at(to.size()), 0.0);
    for (int i = 0; i < fine[0]; ++i)
      for (int j = 0; j < fine[1]; ++j)
        for (int k = 0; k < fine[2]; ++k)
          sums[at((i / ratio[0] * coarse[1] + j / ratio[1]) * coarse[2] + k / ratio[2])] +=
              values[at((i * fine[1] + j) * fine[2] + k)];
    const auto found = apsis::cell_averages().restricted_to_mesh({values.begin(), values.end()}, 1, from, to,
                                                                 {true, false, true});
    RC_ASSERT(found.size() == sums.size());
    for (std::size_t cell = 0; cell < sums.size(); ++cell)
      RC_ASSERT(std::abs(found[cell] - sums[cell] / (ratio[0] * ratio[1] * ratio[2])) <= 1e-12);
  });
}

TEST(restriction, of_point_values_has_eighth_order_across_periodic_faces) {
  const auto f = [](const position& x) {
    return std::sin(std::numbers::pi * x[0]) * std::cos(2.0 * std::numbers::pi * x[1] / 3.0);
  };
  double before = 0.0;
  for (const int n : {12, 24}) {
    const grid to = box(2, {n, n, 1}), from = box(2, {2 * n, 4 * n, 1});
    const double error = largest_difference(
        apsis::point_values().restricted_to_mesh(at_centres(from, f), 2, from, to, {true, true, false}),
        at_centres(to, f));
    if (before > 0.0) {
      EXPECT_GT(std::log2(before / error), 7.5);
    }
    before = error;
  }
  EXPECT_LT(before, 1e-9);
}

TEST(restriction, does_not_mix_gas_on_both_sides_of_a_box) {
  // A polynomial on the lower side of the box along x, another one beyond it. Lines that the box does not
  // cross have the first one alone.
  const auto f = [](const position& x) { return 1.0 + x[0] * x[0] * x[0] - 2.0 * x[1]; };
  const grid whole = box(2, {12, 8, 1}), fine = box(2, {24, 24, 1});
  const grid to = whole.with_solids({{{6, 0, 0}, {2, 8, 1}}}),
             from = fine.with_solids({{{12, 0, 0}, {4, 24, 1}}});
  const auto two = [&](const position& x) { return x[0] < 1.2 ? f(x) : 100.0 - f(x); };
  EXPECT_LT(
      largest_difference(apsis::point_values().restricted_to_mesh(at_centres(from, two), 2, from, to, closed),
                         at_centres(to, two)),
      1e-11);
  // A periodic direction continues the gas above the box by that below it.
  const auto joined = [&](const position& x) { return f({x[0] < 1.2 ? x[0] : x[0] - 2.0, x[1], 0.0}); };
  EXPECT_LT(largest_difference(apsis::point_values().restricted_to_mesh(at_centres(from, joined), 2, from, to,
                                                                        {true, false, false}),
                               at_centres(to, joined)),
            1e-11);
  // Around the corners of a smaller box.
  const grid to_corner = whole.with_solids({{{6, 2, 0}, {2, 3, 1}}}),
             from_corner = fine.with_solids({{{12, 6, 0}, {4, 9, 1}}});
  EXPECT_LT(largest_difference(apsis::point_values().restricted_to_mesh(at_centres(from_corner, f), 2,
                                                                        from_corner, to_corner, closed),
                               at_centres(to_corner, f)),
            1e-11);
}

}  // namespace restriction_test
