// States on different meshes: cell averages are compared with cell averages, point values with point values.
#include <apsis/study/compare.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/mesh/cut_cells.hpp>

#include <cmath>
#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace compare_test {

using namespace apsis;

namespace {

constexpr double pi = std::numbers::pi;

/// Returns a result that was never computed. Every cell has `value` in the first of two components, twice as
/// much in the second.
outcome on_mesh(const std::string& how, int cells,
                const std::function<double(double left, double right)>& value) {
  outcome o;
  o.config = load_case("paper/bgk-accuracy");
  o.config.space.discretization = how;
  o.config.space.cells = {cells};
  o.config.space.domain = {{0.0, 2.0}};
  o.cells = cells;
  o.components = 2;
  o.cell_volume = 2.0 / cells;
  for (int k = 0; k < cells; ++k) {
    const double v = value(2.0 * k / cells, 2.0 * (k + 1) / cells);
    o.state.push_back(v);
    o.state.push_back(2.0 * v);
  }
  return o;
}

outcome averages(int cells) {  // of sin(πx)
  return on_mesh("finite-volume", cells,
                 [](double a, double b) { return (std::cos(pi * a) - std::cos(pi * b)) / (pi * (b - a)); });
}

outcome points(int cells, const std::function<double(double)>& f) {
  return on_mesh("finite-difference", cells, [&](double a, double b) { return f(0.5 * (a + b)); });
}

double largest(const std::vector<double>& a, const std::vector<double>& b) {
  double d = a.size() == b.size() ? 0.0 : HUGE_VAL;
  for (std::size_t k = 0; k < a.size(); ++k) d = std::max(d, std::abs(a[k] - b[k]));
  return d;
}

}  // namespace

TEST(meshes, averages_of_averages_are_averages) {
  for (const int ratio : {1, 2, 3, 8})
    // Each average has the rounding errors of two cosines, divided by the length of its fine cell.
    EXPECT_LE(largest(on_mesh_of(averages(10), averages(10 * ratio)), averages(10).state),
              1e-15 * 10 * ratio);
}

TEST(meshes, averaging_keeps_the_integral_of_any_values) {
  check_property("integral", [] {
    const int ratio = *rc::gen::inRange(2, 9), cells = *rc::gen::inRange(1, 12);
    const auto values = *rc::gen::container<std::vector<int>>(static_cast<std::size_t>(ratio * cells),
                                                              rc::gen::inRange(-1000, 1000));
    std::size_t next = 0;
    const auto fine = on_mesh("finite-volume", ratio * cells, [&](double, double) { return values[next++]; });
    const auto coarse = on_mesh_of(on_mesh("finite-volume", cells, [](double, double) { return 0; }), fine);
    for (int k = 0; k < cells; ++k) {
      double sum = 0.0;
      for (int m = 0; m < ratio; ++m) sum += values[static_cast<std::size_t>(k * ratio + m)];
      RC_ASSERT(coarse[static_cast<std::size_t>(2 * k)] == sum / ratio);
      RC_ASSERT(coarse[static_cast<std::size_t>(2 * k + 1)] == 2.0 * sum / ratio);
    }
  });
}

TEST(meshes, point_values_are_kept_where_centres_coincide) {
  const auto f = [](double x) { return std::exp(std::sin(pi * x)); };
  for (const int ratio : {1, 3, 5}) {
    const auto fine = points(12 * ratio, f);
    const auto here = on_mesh_of(points(12, f), fine);
    for (int k = 0; k < 12; ++k)
      EXPECT_EQ(here[static_cast<std::size_t>(2 * k)],
                fine.state[static_cast<std::size_t>(2 * (k * ratio + ratio / 2))]);
  }
}

class interpolated_points : public testing::TestWithParam<const char*> {};

TEST_P(interpolated_points, are_of_eighth_order_also_at_the_ends) {
  const bool periodic = std::string(GetParam()) == "periodic";
  // There are no values beyond the ends of an open domain. The function has no periodic continuation.
  const std::function<double(double)> f =
      periodic ? std::function<double(double)>([](double x) { return std::sin(pi * x); })
               : [](double x) { return std::sin(pi * x + 0.3) + x * x; };
  for (const int ratio : {2, 4}) {
    double before = 0.0;
    for (const int cells : {10, 20, 40}) {
      auto coarse = points(cells, f);
      coarse.config.space.boundary = GetParam();
      const double error = largest(on_mesh_of(coarse, points(ratio * cells, f)), coarse.state);
      // Seventh order would suffice for a scheme of fifth order. The stencil has eighth.
      if (before > 0.0) {
        EXPECT_GE(std::log2(before / error), 7.5) << ratio << " " << cells;
      }
      before = error;
    }
    EXPECT_LE(before, 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(boundaries, interpolated_points, testing::Values("periodic", "outflow"));

TEST(meshes, interpolation_reproduces_polynomials_of_degree_seven) {
  check_property("degree seven", [] {
    const auto c = *rc::gen::container<std::vector<int>>(8, rc::gen::inRange(-5, 6));
    const auto f = [&c](double x) {
      double value = 0.0;
      for (const int a : c) value = value * (x - 1.0) + a;
      return value;
    };
    const int cells = *rc::gen::inRange(3, 20), fine = cells + *rc::gen::inRange(0, 60);
    RC_PRE(fine >= 8);
    auto coarse = points(cells, f);
    coarse.config.space.boundary = "outflow";
    // The values are up to 40. The weights of one-sided stencils are a few hundred.
    RC_ASSERT(largest(on_mesh_of(coarse, points(fine, f)), coarse.state) <= 1e-11);
  });
}

TEST(norms, are_weighted_with_cell_and_velocity) {
  auto a = points(4, [](double) { return 1.0; });
  a.component_weight = 0.5;
  std::vector<double> b(8, 1.0);
  b[2] = 4.0;
  for (std::size_t k = 1; k < 8; k += 2) b[k] = 2.0;
  // The states have one difference of 3, with V = (2/4)·(1/2).
  EXPECT_DOUBLE_EQ(difference_norm(a, b, error_norm::l1), 3.0 * 0.25);
  EXPECT_DOUBLE_EQ(difference_norm(a, b, error_norm::l2), std::sqrt(9.0 * 0.25));
  EXPECT_DOUBLE_EQ(difference_norm(a, b, error_norm::linf), 3.0);
  b[5] = std::nan("");
  for (const auto norm : {error_norm::l1, error_norm::l2, error_norm::linf})
    EXPECT_TRUE(std::isnan(difference_norm(a, b, norm)));
}

TEST(norms, have_names) {
  for (const std::string name : {"l1", "l2", "linf"}) EXPECT_EQ(to_string(find_norm(name)), name);
  EXPECT_THROW(find_norm("l3"), input_error);
}

TEST(meshes, that_cannot_be_compared_are_refused) {
  const auto compare = [](const outcome& run, const outcome& reference) { on_mesh_of(run, reference); };
  const auto one = [](double) { return 1.0; };
  bad_input::expect_refused({
      {[&] { compare(averages(20), averages(30)); },
       {"a reference with 30 cells along x cannot be compared with a run of 20 (averages need whole cells); "
        "choose a multiple of 20 along x"}},
      {[&] { compare(averages(20), averages(10)); }, {"coarser"}},
      {[&] { compare(points(20, one), points(10, one)); }, {"coarser"}},
  });
  EXPECT_NO_THROW(compare(points(20, one), points(30, one)));
  bad_input::expect_refused({
      {[&] { compare(averages(10), points(20, one)); }, {"space.formulation"}},
  });
  auto elsewhere = averages(20);
  elsewhere.config.space.domain = {{0.0, 1.0}};
  bad_input::expect_refused({
      {[&] { compare(averages(10), elsewhere); }, {"space.domain"}},
  });
}

namespace {

/// A result on the mesh of a gas with one component, `value` in cells with an unknown and NaN in all others.
outcome constant_on(const case_config& config, double value) {
  outcome o;
  o.config = config;
  const grid mesh = make_mesh(config);
  o.cells = mesh.size();
  o.components = 1;
  o.cell_volume = mesh.cell_volume();
  for (int cell = 0; cell < mesh.size(); ++cell)
    o.state.push_back(has_unknown(mesh, cell) ? value : std::nan(""));
  return o;
}

case_config gas_in(const std::string& space, const std::vector<std::string>& overrides = {}) {
  return parse_case(
      "[model]\nname = \"bgk\"\n[initial]\nrho = 1\nT = 1\n[space]\nboundary = \"diffuse\"\n" + space +
          "[velocity]\nmax = 5\npoints = 12\n[time]\nmethod = \"md-imex-3-2\"\nend = 1\ndt = 0.1\n",
      "gas", overrides);
}

const std::string rings = "geometry = \"axisymmetric\"\ncells = [4, 3]\ndomain = [[0, 2], [1, 4]]\n",
                  beside_a_box =
                      "cells = [8, 6]\ndomain = [[0, 4], [0, 3]]\n[[space.solid]]\nfrom = [1, 1]\n"
                      "to = [2, 3]\n",
                  past_a_disc =
                      "cells = [20, 20]\ndomain = [[-2, 2], [-2, 2]]\n[[space.body]]\n"
                      "shape = \"circle\"\ncentre = [0.03, 0.01]\nradius = 1\n";

double l1_of_one(const case_config& config) {
  const outcome one = constant_on(config, 1.0), two = constant_on(config, 2.0);
  EXPECT_EQ(difference_norm(one, two, error_norm::linf), 1.0);
  EXPECT_DOUBLE_EQ(std::pow(difference_norm(one, two, error_norm::l2), 2),
                   difference_norm(one, two, error_norm::l1));
  return difference_norm(one, two, error_norm::l1);
}

}  // namespace

TEST(norms, weigh_rings_and_the_gas_beside_boxes_and_bodies_with_their_volumes) {
  EXPECT_NEAR(l1_of_one(gas_in(rings)), pi * (16.0 - 1.0) * 2.0, 1e-12);
  EXPECT_NEAR(l1_of_one(gas_in(beside_a_box)), 12.0 - 2.0, 1e-12);
  // Walls are chords of lengths L up to 0.2 √2. Between each chord and the circle lies an area of L³/12.
  EXPECT_NEAR(l1_of_one(gas_in(past_a_disc)), 16.0 - pi, 2.0 * pi * 0.08 / 12.0);
}

TEST(meshes, with_solid_boxes_are_restricted_beside_them) {
  const case_config coarse = gas_in(beside_a_box), fine = gas_in(beside_a_box, {"space.cells=[16,18]"});
  EXPECT_NEAR(difference_norm(constant_on(coarse, 1.0), constant_on(fine, 2.0), error_norm::l1), 10.0, 1e-12);
}

TEST(meshes, with_other_obstacles_or_other_cells_past_a_body_are_refused) {
  const auto compare = [](const case_config& run, const case_config& reference) {
    return [run, reference] { on_mesh_of(constant_on(run, 1.0), constant_on(reference, 1.0)); };
  };
  const std::string plane = rings.substr(rings.find("cells"));
  bad_input::expect_refused({
      {compare(gas_in(past_a_disc), gas_in(past_a_disc, {"space.cells=[40,40]"})),
       {"a run and its reference differ in 'space.cells' (meshes past a body have different cut cells); "
        "leave "
        "it the same in both"}},
      {compare(gas_in(past_a_disc), gas_in(past_a_disc, {"space.body.1.radius=1.1"})),
       {"a run and its reference differ in 'space.body' (they have no common mesh)"}},
      {compare(gas_in(beside_a_box), gas_in(beside_a_box, {"space.solid.1.to=[2,2]"})),
       {"a run and its reference differ in 'space.solid' (they have no common mesh)"}},
      {compare(gas_in(rings), gas_in(plane)), {"'space.geometry' (one is axisymmetric)"}},
      {compare(gas_in(rings), gas_in(rings, {"space.cells=[8,2]"})),
       {"a reference with 2 cells along r cannot be compared with a run of 3 (it is coarser)"}},
  });
}

}  // namespace compare_test
