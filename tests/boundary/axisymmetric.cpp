// The axis, and other boundaries of the unknowns F = r f.
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/domain.hpp>
#include <apsis/boundary/radial_boundary.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

namespace axisymmetric_boundary_test {

namespace {

using apsis::domain;
using apsis::face;
using apsis::field;
using apsis::grid;
using apsis::position;
using apsis::radial_boundary;
using apsis::velocity_set;
using testing::ElementsAre;

/// (v_r, v_θ) = (±1, ±2), in the order (+, +), (−, +), (−, −), (+, −).
velocity_set four() {
  return {{{1.0, -1.0, -1.0, 1.0}, {2.0, 2.0, -2.0, -2.0}}, {1.0, 1.0, 1.0, 1.0}};
}

/// Emits 2 + f of the first outgoing component, f of the first ghost row, t, and the radius.
class recording final : public apsis::incoming_boundary {
 public:
  void incoming_given_outgoing(const face&, double t, const position& at, const double* outgoing,
                               std::span<const double* const> ghosts, double* incoming) const override {
    incoming[0] = 2.0 + outgoing[0];
    incoming[1] = ghosts[0][1];
    incoming[2] = t;
    incoming[3] = at[1];
  }
  std::array<double, 3> wall_velocity(double t, const position&) const override { return {t, 0.0, 0.0}; }
  std::optional<std::vector<double>> entropy_bound() const override { return std::vector<double>{}; }
};

/// Returns rows with the components 10 i + k.
field numbered(int cells, int components) {
  field u(cells, components);
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < components; ++k) u.row(i)[k] = 10.0 * i + k;
  return u;
}

}  // namespace

TEST(axis, ghost_rows_are_the_odd_continuation_with_both_velocities_reversed) {
  const auto outer = apsis::make_boundary("outflow");
  const auto axis = apsis::make_boundary("axis");
  domain space({grid::line(4, 0.0, 1.0), four()}, {{axis, outer}});
  const field u = numbered(4, 4);
  space.reserve(4, 3);
  space.fill_ghosts(0.0, u);
  std::vector<const double*> rows;
  space.segment_rows(u, 0, 0, -3, 0, rows);
  const auto row = [&](std::size_t i) { return std::vector<double>(rows[i], rows[i] + 4); };
  EXPECT_THAT(row(2), ElementsAre(-2.0, -3.0, -0.0, -1.0));
  EXPECT_THAT(row(1), ElementsAre(-12.0, -13.0, -10.0, -11.0));
  EXPECT_THAT(row(0), ElementsAre(-22.0, -23.0, -20.0, -21.0));
}

TEST(axis, values_that_enter_are_those_that_leave_with_the_radial_velocity_reversed) {
  const face where{0, false};
  const auto axis = apsis::make_boundary("axis")->prepared(where, four());
  ASSERT_NE(axis, nullptr);
  EXPECT_TRUE(axis->is_axis());
  EXPECT_TRUE(axis->prescribes_incoming(100, 2));
  const std::array<double, 4> outgoing = {0.0, 3.0, 4.0, 0.0};
  std::array<double, 4> incoming{};
  axis->incoming(where, 0.0, {}, outgoing.data(), incoming.data());
  EXPECT_EQ(incoming[0], 3.0);
  EXPECT_EQ(incoming[3], 4.0);
  EXPECT_FALSE(axis->entropy_bound().has_value());
}

TEST(axis, needs_a_lower_end_and_symmetric_velocities_in_the_plane) {
  const auto axis = apsis::make_boundary("axis");
  bad_input::expect_refused({
      {[&] { axis->prepared({0, true}, four()); }, {"boundary 'axis' at the upper end of a direction"}},
  });
  const velocity_set on_a_line({{1.0, -1.0}}, {1.0, 1.0});
  bad_input::expect_refused({
      {[&] { axis->prepared({0, false}, on_a_line); }, {"the velocities have no v_theta after v_r"}},
  });
  const velocity_set lopsided({{1.0, -1.0}, {2.0, 2.0}}, {1.0, 1.0});
  bad_input::expect_refused({
      {[&] { axis->prepared({0, false}, lopsided); }, {"the velocities are not symmetric"}},
  });
  const auto gas = apsis::find_model("bgk").make([] {
    auto parts = apsis::default_config(apsis::find_model("bgk"));
    parts.velocity = {6.0, 12};
    return parts;
  }());
  bad_input::expect_refused({
      {[&] { apsis::make_boundary("axis", *gas); }, {"boundary 'axis' cannot be used"}},
  });
}

TEST(radial_boundary, shows_f_to_the_condition_and_multiplies_what_it_returns) {
  const auto inner = std::make_shared<recording>();
  const auto side = radial_boundary(inner, 1, 0.25).prepared({1, true}, four());
  const std::array<double, 4> outgoing = {6.0, 0.0, 0.0, 0.0}, ghost = {0.0, 12.0, 0.0, 0.0};
  std::array<double, 4> incoming{};
  const std::array<const double*, 1> ghosts = {ghost.data()};
  side->incoming_given_outgoing({1, true}, 5.0, {0.5, 3.0, 0.0}, outgoing.data(), ghosts, incoming.data());
  EXPECT_THAT(incoming, ElementsAre(3.0 * (2.0 + 2.0), 3.0 * 4.0, 3.0 * 5.0, 3.0 * 3.0));
  EXPECT_TRUE(side->prescribes_incoming(1, 1));
  EXPECT_EQ(side->wall_velocity(7.0, {})[0], 7.0);
  EXPECT_EQ(&side->undecorated(), inner.get());
  EXPECT_FALSE(side->entropy_bound().has_value());
  EXPECT_FALSE(side->periodic());
}

TEST(radial_boundary, repeats_rows_along_the_axis_and_their_f_along_the_radius) {
  const auto outflow = std::make_shared<radial_boundary>(apsis::make_boundary("outflow"), 1, 1.0);
  const auto axis = apsis::make_boundary("axis");
  const velocity_set v({{3.0, 3.0, 3.0, 3.0}, {1.0, -1.0, -1.0, 1.0}, {2.0, 2.0, -2.0, -2.0}},
                       {1.0, 1.0, 1.0, 1.0});
  const grid mesh(2, {3, 3, 1}, {0.0, 0.0, 0.0}, {3.0, 3.0, 0.0});
  domain space({mesh, v}, {{outflow, outflow}, {axis, outflow}});
  const field u = numbered(9, 4);
  space.reserve(4, 2);
  space.fill_ghosts(0.0, u);
  std::vector<const double*> rows;
  space.segment_rows(u, 0, 1, 3, 5, rows);
  EXPECT_EQ(rows[0], u.row(7));  // without a copy
  space.segment_rows(u, 1, 2, 3, 5, rows);
  // Cells at r = 3.5 and 4.5 repeat the f of the cell at r = 2.5. The row of that cell begins with 80.
  EXPECT_DOUBLE_EQ(rows[0][0], 80.0 * 3.5 / 2.5);
  EXPECT_DOUBLE_EQ(rows[1][3], 83.0 * 4.5 / 2.5);
}

TEST(radial_boundary, refuses_mirror_images_at_a_cylinder_alone) {
  const radial_boundary side(apsis::make_boundary("symmetry"), 1, 1.0);
  const velocity_set v({{1.0, -1.0, 1.0, -1.0}, {1.0, 1.0, -1.0, -1.0}}, {1.0, 1.0, 1.0, 1.0});
  bad_input::expect_refused({
      {[&] { side.prepared({1, true}, v); },
       {"a boundary with mirror images at r = const (a cylinder is no plane of symmetry)"}},
  });
  EXPECT_NE(side.prepared({0, true}, v), nullptr);
}

}  // namespace axisymmetric_boundary_test
