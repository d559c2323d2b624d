// Collisions of cell averages at the centres of cells.
#include "bgk_case.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/semidiscrete/centre_rows.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <gmock/gmock.h>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace collision_centre_test {

namespace {

using apsis::field;
using apsis::grid;
namespace centre_rows = apsis::centre_rows;

std::vector<double> at_centres(const grid& mesh, const std::function<double(double)>& f) {
  std::vector<double> values;
  for (int i = 0; i < mesh.size(); ++i) values.push_back(f(mesh.centre(i, 0)));
  return values;
}

/// Sets smooth data off equilibrium.
void smooth_row(const apsis::relaxation_model& m, double x, std::vector<double>& row) {
  m.initial()[2].point_value({x}, row);
}

field smooth(const apsis::relaxation_model& m, const grid& mesh) {
  std::vector<double> row(static_cast<std::size_t>(m.components()));
  return sample(mesh, m.components(), true, [&](double x, int k) {
    smooth_row(m, x, row);
    return row[static_cast<std::size_t>(k)];
  });
}

/// Returns the largest l1 difference between the averages after a stage and those of the exact solution. The
/// exact solution is v = u + a Q(v)/ε at each point. Only the cells first … n−1−first count.
double error_of_stage(const apsis::relaxation_model& m, int n, const std::string& ends, int first) {
  constexpr double a = 0.3;
  const grid mesh = grid::line(n, 0.0, 2.0);
  const auto epsilon = [](double x) { return 1.2 + std::sin(std::numbers::pi * x); };
  const auto q = apsis::make_cell_centre_collision(m, space_of(mesh, ends), true, at_centres(mesh, epsilon));
  field u = smooth(m, mesh);
  q->solve(0.0, a, 0.0, u);
  std::vector<double> row(static_cast<std::size_t>(m.components())), e = row, omega(3);
  const field exact = sample(mesh, m.components(), true, [&](double x, int k) {
    smooth_row(m, x, row);
    m.moments(row.data(), omega.data());
    m.equilibrium(omega.data(), e.data());
    const double mu = a / epsilon(x);
    const auto component = static_cast<std::size_t>(k);
    return (row[component] + mu * e[component]) / (1.0 + mu);
  });
  double sum = 0.0;
  for (int i = first; i < n - first; ++i)
    for (int k = 0; k < m.components(); ++k) sum += std::abs(u.row(i)[k] - exact.row(i)[k]);
  return sum / n;
}

/// Returns rows that jump by many powers of ten between cells and velocities, or by six between two halves.
field rough(int cells, int components) {
  field u(cells, components);
  const bool two_halves = *rc::gen::arbitrary<bool>();
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < components; ++k) {
      const double power =
          two_halves ? (2 * i < cells ? 0.0 : -6.0) : *rc::gen::element(0.0, -1.0, -2.0, -4.0, -8.0, -30.0);
      u.row(i)[k] = std::pow(10.0, power) * (1.0 + 0.1 * ((7 * i + 3 * k) % 5));
    }
  return u;
}

/// Returns the value at the centre of a cell; average(i) points to the average of cell i − 6.
template <class Average>
double value_at_centre(const Average& average, bool limited) {
  std::array<const double*, 2 * centre_rows::reach + 1> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = average(i);
  double p = 0.0;
  centre_rows::values(rows.data() + centre_rows::reach, 1, limited, 1, &p);
  return p;
}

}  // namespace

TEST(collision_centre, values_invert_averages_up_to_the_tail_of_the_inverse) {
  // For p_i = cos(θ i), δ²p = −2(1 − cos θ) p, so M is a factor.
  constexpr double pi = std::numbers::pi;
  for (const double theta : {0.1, 0.7, 2.0, pi}) {
    const double factor = 1.0 - (1.0 - std::cos(theta)) / 12.0;
    std::array<double, 2 * centre_rows::reach + 1> averages{};
    for (int i = -centre_rows::reach; i <= centre_rows::reach; ++i)
      averages[static_cast<std::size_t>(i + centre_rows::reach)] = factor * std::cos(theta * i);
    const double p = value_at_centre([&](std::size_t i) { return &averages[i]; }, false);
    // The tolerance covers the rest of the series, A Σ_{k>6} |ρ|^k |2 cos(θk) − 2| ≤ 4 A |ρ|⁷/(1 − |ρ|).
    EXPECT_NEAR(p, 1.0, 2e-9) << theta;
  }
}

TEST(collision_centre, values_of_constant_data_are_the_averages) {
  // The differences vanish in floating point arithmetic too.
  for (const double average : {1.0, 0.1, 1e-300, 3e200}) {
    EXPECT_EQ(value_at_centre([&](std::size_t) { return &average; }, true), average);
  }
}

TEST(collision_centre, values_of_neighbours_do_not_depend_on_their_number) {
  check_property("values of some cells", [] {
    const int count = *rc::gen::inRange(1, 12), n = *rc::gen::inRange(1, 20);
    const bool limited = *rc::gen::arbitrary<bool>();
    const auto cells = static_cast<std::size_t>(count) + 2 * centre_rows::reach,
               width = static_cast<std::size_t>(n);
    std::vector<std::vector<double>> averages(cells);
    std::vector<const double*> rows;
    for (auto& row : averages) {
      row = *rc::gen::container<std::vector<double>>(
          width, rc::gen::map(rc::gen::inRange(0, 1 << 20), [](int k) { return k / 1048576.0; }));
      rows.push_back(row.data());
    }
    std::vector<double> together(static_cast<std::size_t>(count) * width);
    centre_rows::values(rows.data() + centre_rows::reach, count, limited, n, together.data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      std::vector<double> alone(width);
      centre_rows::values(rows.data() + centre_rows::reach + i, 1, limited, n, alone.data());
      for (std::size_t k = 0; k < width; ++k) RC_ASSERT(together[i * width + k] == alone[k]);
    }
  });
}

TEST(collision_centre, negative_sums_are_found_anywhere_in_a_row) {
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  check_property("is_negative", [] {
    const int n = *rc::gen::inRange(1, 40);
    const auto number = [] { return *rc::gen::inRange(0, 1 << 20) / 1048576.0; };
    const auto one_in = [](int several) { return *rc::gen::inRange(0, several) == 0; };
    std::vector<double> average, d;
    bool expected = false;
    for (int k = 0; k < n; ++k) {
      const double point = number();
      d.push_back(number() - point);
      average.push_back(one_in(60) ? nan : one_in(9) ? 0.5 : point);  // v − p ≥ −p
      expected = expected || average.back() + d.back() < 0.0;
    }
    RC_ASSERT(centre_rows::is_negative(average.data(), d.data(), n) == expected);
  });
}

TEST(collision_centre, lower_limits_points_where_the_average_would_be_negative_or_everywhere) {
  const std::vector<double> average = {1.0, 1.0, 1.0, 2.0, 2.0, 0.5, 0.5, 1.0, 1.0},
                            d = {-0.5, -2.0, -1.0, -3.0, 0.0, -1.0, 1.0, -1.5, -1.5},
                            points = {3.0, 3.0, 3.0, 1.0, 3.0, 0.25, 2.0, 4.0, 0.5};
  auto some = points, all = points;
  centre_rows::lower(average.data(), d.data(), false, 9, some.data());
  centre_rows::lower(average.data(), d.data(), true, 9, all.data());
  EXPECT_THAT(some, testing::ElementsAre(3.0, 1.0, 3.0, 1.0, 3.0, 0.25, 2.0, 1.0, 0.5));
  EXPECT_THAT(all, testing::ElementsAre(1.0, 1.0, 1.0, 1.0, 2.0, 0.25, 0.5, 1.0, 0.5));
}

TEST(collision_centre, is_of_fourth_order) {
  const auto m = small_bgk();
  EXPECT_GT(std::log2(error_of_stage(*m, 32, "periodic", 0) / error_of_stage(*m, 64, "periodic", 0)), 3.9);
  // Cells at the ends and most of their neighbours are excluded. M^-1 depends exponentially less
  // on farther cells.
  EXPECT_GT(std::log2(error_of_stage(*m, 32, "outflow", 4) / error_of_stage(*m, 64, "outflow", 8)), 3.9);
  // In the two end cells of n, the position is wrong by h/24. This means second order in the l1 norm.
  EXPECT_GT(std::log2(error_of_stage(*m, 32, "outflow", 0) / error_of_stage(*m, 64, "outflow", 0)), 1.9);
}

TEST(collision_centre, keeps_any_nonnegative_data_so_and_conserves) {
  const auto m = small_bgk();
  check_property("nonnegative and conservative", [&] {
    const grid mesh = grid::line(*rc::gen::inRange(7, 14), 0.0, 2.0);
    const std::string ends = *rc::gen::element<std::string>("periodic", "outflow", "symmetry");
    const double epsilon = *rc::gen::element(0.0, 1e-8, 1e-2, 1.0, 1e6);
    const auto q = apsis::make_cell_centre_collision(*m, space_of(mesh, ends), true,
                                                     at_centres(mesh, [=](double x) { return epsilon * x; }));
    field u = rough(mesh.size(), m->components());
    const field before = u;
    q->solve(0.0, *rc::gen::element(1e-4, 1e-2, 1.0), *rc::gen::element(0.0, -1e-4, -1.0), u);
    double size = 0.0;
    for (int i = 0; i < u.cells(); ++i)
      for (int k = 0; k < u.components(); ++k) {
        RC_ASSERT(u.row(i)[k] >= 0.0);
        size += before.row(i)[k];
      }
    // Momentum and energy weigh f by up to v and v²/2 of the small grid, |v| ≤ 15. The mass has rounding
    // errors of 1e-14.
    const std::array<double, 3> largest = {1.0, 8.0, 32.0};
    for (int k = 0; k < 3; ++k) {
      const double error = std::abs(total(*m, u, k) - total(*m, before, k));
      RC_ASSERT(error <= 1e-14 * size * largest[static_cast<std::size_t>(k)]);
    }
  });
}

TEST(collision_centre, needs_its_limiter_next_to_jumps) {
  const auto m = small_bgk();
  const grid mesh = grid::line(12, 0.0, 2.0);
  field jump = smooth(*m, mesh);
  for (int i = 6; i < 12; ++i)
    for (int k = 0; k < jump.components(); ++k) jump.row(i)[k] *= 1e-6;
  const auto solved = [&](bool limited) {
    const auto q = apsis::make_cell_centre_collision(*m, space_of(mesh), limited,
                                                     at_centres(mesh, [](double) { return 1.0; }));
    field u = jump;
    q->solve(0.0, 0.1, 0.0, u);
    return u;
  };
  EXPECT_GE(smallest(solved(true)), 0.0);
  try {
    solved(false);
    FAIL() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_EQ(failure.site().cell, 6);
    EXPECT_THAT(failure.problem(), testing::HasSubstr("is not positive"));
  }
}

TEST(collision_centre, rate_is_the_slope_of_a_short_stage) {
  const auto m = small_bgk();
  const grid mesh = grid::line(16, 0.0, 2.0);
  for (const char* ends : {"periodic", "outflow"}) {
    const auto q = apsis::make_cell_centre_collision(*m, space_of(mesh, ends), false,
                                                     at_centres(mesh, [](double x) { return 0.1 + x; }));
    const field u = smooth(*m, mesh);
    field stage = u, rate(u.cells(), u.components());
    constexpr double a = 1e-7;
    q->solve(0.0, a, 0.0, stage);
    const apsis::target<field, double> to{&rate, 0.0, 1.0, true};
    q->add_collision(0.0, u, {&to, 1});
    // The slope differs by a/(2ε) relative to rates below 10. The roundings of u add 1e-16/a.
    for (int i = 0; i < u.cells(); ++i)
      for (int k = 0; k < u.components(); ++k)
        EXPECT_NEAR((stage.row(i)[k] - u.row(i)[k]) / a, rate.row(i)[k], 1e-5) << ends << i << " " << k;
  }
}

TEST(collision_centre, states_what_it_cannot_do) {
  const auto m = small_bgk();
  const auto build = [&](int cells, const std::string& unknowns) {
    apsis::problem_builder(*m)
        .on(grid::line(cells, 0.0, 1.0))
        .with_discretization(unknowns)
        .with_collisions_at("centres")
        .with_reconstruction(scheme("weno5-z", apsis::limited_reconstruction::limits::nothing).scheme)
        .build();
  };
  bad_input::expect_refused({
      {[&] { build(6, "finite-volume"); }, {"give at least 7"}},
      {[&] { build(8, "finite-difference"); }, {"point values, which collide where they are"}},
  });
  EXPECT_NO_THROW(build(7, "finite-volume"));
}

}  // namespace collision_centre_test
