// Mirror images at a plane of symmetry.
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/domain.hpp>
#include <apsis/boundary/mirrored_components.hpp>
#include <apsis/core/errors.hpp>

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>

namespace symmetry_test {

namespace {

using apsis::mirrored_components;
using apsis::velocity_set;
using testing::ElementsAre;

/// Returns shuffled points (±a, ±b) with random a, b > 0, `sets` sets of components, and weights that depend
/// on |v| alone.
velocity_set random_symmetric_set(int sets) {
  std::vector<std::array<double, 3>> points;  // a, b, weight
  const int count = *rc::gen::inRange(1, 8);
  for (int k = 0; k < count; ++k) {
    const double a = k + 0.5, b = *rc::gen::inRange(1, 100) / 10.0, w = *rc::gen::inRange(1, 100) / 7.0;
    for (const double sign : {1.0, -1.0}) {
      points.push_back({sign * a, b, w});
      points.push_back({sign * a, -b, w});
    }
  }
  for (std::size_t k = points.size(); k > 1; --k)
    std::swap(points[k - 1], points[static_cast<std::size_t>(*rc::gen::inRange(0, static_cast<int>(k)))]);
  apsis::aligned_vector<double> x, y;
  std::vector<double> weights;
  for (const auto& p : points) {
    x.push_back(p[0]);
    y.push_back(p[1]);
    weights.push_back(p[2]);
  }
  return {{x, y}, weights, sets};
}

}  // namespace

RC_GTEST_PROP(mirrored_components, have_the_opposite_normal_velocity_in_the_same_set, ()) {
  const int sets = *rc::gen::inRange(1, 4);
  const velocity_set v = random_symmetric_set(sets);
  for (const int direction : {0, 1}) {
    const auto mirrored = mirrored_components(v, direction);
    RC_ASSERT(mirrored.size() == static_cast<std::size_t>(v.components()));
    for (std::size_t k = 0; k < mirrored.size(); ++k) {
      const auto m = static_cast<std::size_t>(mirrored[k]);
      RC_ASSERT(mirrored[m] == static_cast<int>(k));
      RC_ASSERT(m / static_cast<std::size_t>(v.size()) == k / static_cast<std::size_t>(v.size()));
      RC_ASSERT(v.speeds(direction)[m] == -v.speeds(direction)[k]);
      RC_ASSERT(v.speeds(1 - direction)[m] == v.speeds(1 - direction)[k]);
    }
  }
}

TEST(mirrored_components, of_a_particle_at_rest_are_itself) {
  EXPECT_THAT(mirrored_components({{{1.0, 0.0, -1.0}}, {1.0, 2.0, 1.0}}, 0), ElementsAre(2, 1, 0));
  EXPECT_THAT(mirrored_components({{{-0.0}}, {1.0}}, 0), ElementsAre(0));
}

TEST(mirrored_components, do_not_exist_without_a_partner_of_the_same_weight) {
  for (const velocity_set& bad :
       {velocity_set({{1.0, -1.5}}, {1.0, 1.0}), velocity_set({{1.0, -1.0}}, {1.0, 2.0})}) {
    bad_input::expect_refused({{[&] { mirrored_components(bad, 0); },
                                {"the velocities are not symmetric (the one with v = 1 in direction 1"}}});
  }
}

TEST(symmetry, ghost_rows_are_mirror_images_at_both_faces) {
  const velocity_set v({{2.0, 0.0, -2.0}}, {1.0, 1.0, 1.0});
  const auto kind = std::shared_ptr<const apsis::boundary>(apsis::make_boundary("symmetry"));
  apsis::domain space({apsis::grid::line(4, 0.0, 1.0), v}, {{kind, kind}});
  EXPECT_TRUE(space.entropy_bounds().has_value());
  apsis::field u(4, 3);
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) u.row(i)[k] = 10.0 * i + k;
  space.reserve(3, 3);
  space.fill_ghosts(0.0, u);
  std::vector<const double*> rows;
  space.segment_rows(u, 0, 0, -3, 7, rows);
  const auto row = [&](int i) {
    return std::vector<double>(rows[static_cast<std::size_t>(i + 3)],
                               rows[static_cast<std::size_t>(i + 3)] + 3);
  };
  EXPECT_THAT(row(-1), ElementsAre(2.0, 1.0, 0.0));
  EXPECT_THAT(row(-3), ElementsAre(22.0, 21.0, 20.0));
  EXPECT_THAT(row(4), ElementsAre(32.0, 31.0, 30.0));
  EXPECT_THAT(row(6), ElementsAre(12.0, 11.0, 10.0));
}

}  // namespace symmetry_test
