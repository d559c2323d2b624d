// Walls with any normal that reflect a part of the molecules, or all.
#include "boundary/oblique_rows.hpp"

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/oblique_reflection.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>

#include <memory>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique_walls_test {
namespace {

using namespace oblique_rows;

std::unique_ptr<apsis::model> gas_of(const char* name, int d) {
  auto parts = apsis::default_config(apsis::find_model(name));
  parts.space_dimensions = 2;
  parts.parameters["velocity_dimensions"] = d;
  parts.parameters["degrees_of_freedom"] = 3;
  parts.velocity.max = 6.0;
  parts.velocity.points = 12;
  return apsis::find_model(name).make(parts);
}

}  // namespace

TEST(oblique_walls, mix_reflection_and_emission_by_the_accommodation) {
  std::mt19937 generator(6);
  for (const int d : {2, 3}) {
    const auto gas = gas_of("bgk", d);
    const velocity_set set = gas->velocities();
    const vector n = random_normal(2, generator);
    const auto inward = inward_of(set, n);
    const auto f = random_row(row_kind::positive, at(set.components()), generator);
    const auto with = [&](const apsis::face_quantity& alpha, double t) {
      std::vector<apsis::face_quantity> velocity = {-0.3 * n[1], 0.3 * n[0]};
      velocity.resize(at(d), 0.1);
      const auto made = apsis::make_boundary(
          "diffuse", *gas, {{"T", {1.2}}, {"velocity", velocity}, {"accommodation", {alpha}}});
      std::vector<double> values(f.size());
      made->oblique(set)->emit({n, {}, t}, inward.data(), f.data(), values.data());
      return values;
    };
    const auto specular = with(0.0, 0.0), diffuse = with(1.0, 0.0), half = with(0.5, 0.0),
               changes = with(apsis::face_quantity([](double t, const apsis::position&) { return t; }), 0.5);
    std::vector<double> reflected(f.size()), mirror(f.size());
    apsis::oblique_reflection(set).reflect(n, inward.data(), f.data(), reflected.data());
    apsis::make_boundary("symmetry", *gas)
        ->oblique(set)
        ->emit({n, {}, 0.0}, inward.data(), f.data(), mirror.data());
    for (std::size_t k = 0; k < f.size(); ++k) {
      if (!(inward[k] > 0.0)) continue;
      EXPECT_EQ(specular[k], reflected[k]);
      EXPECT_EQ(mirror[k], reflected[k]);
      EXPECT_EQ(changes[k], half[k]);
      EXPECT_NEAR(half[k], 0.5 * (specular[k] + diffuse[k]), 1e-15 * half[k]);
    }
    const auto arrives = fluxes_of(set, n, inward, -1.0, f);
    for (const auto& row : {specular, diffuse, half})
      EXPECT_LT(difference(arrives, fluxes_of(set, n, inward, 1.0, row), true), 1e-14);
    EXPECT_GT(difference(arrives, fluxes_of(set, n, inward, 1.0, half), false), 1e-3);
    EXPECT_THAT([&] { with(1.5, 0.0); },
                testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr(
                    "the accommodation of a diffuse wall is 1.5 at t = 0 (a number from 0 to 1 is needed)")));
    EXPECT_THAT([&] { with(apsis::face_quantity([](double t, const apsis::position&) { return t; }), 2.0); },
                testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("is 2 at t = 2 (")));
  }
}

TEST(oblique_walls, of_symmetry_need_the_components_of_a_gas) {
  const auto gas = gas_of("bgk", 2);
  EXPECT_EQ(apsis::make_boundary("symmetry")->oblique(gas->velocities()), nullptr);
  const auto entry = apsis::try_find_model("broadwell-plane");
  const auto other = entry->make(apsis::default_config(*entry));
  EXPECT_EQ(apsis::make_boundary("symmetry", *other)->oblique(other->velocities()), nullptr);
}

}  // namespace oblique_walls_test
