// Walls with any normal that reflect some or all molecules.
#include "boundary/oblique_rows.hpp"

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/oblique_reflection.hpp>
#include <apsis/boundary/wall_temperature.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>

#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/bad_input.hpp>

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
    bad_input::expect_refused({
        {[&] { with(1.5, 0.0); },
         {"the accommodation of a diffuse wall is 1.5 at t = 0 (a number from 0 to 1 is needed)"}},
        {[&] { with(apsis::face_quantity([](double t, const apsis::position&) { return t; }), 2.0); },
         {"is 2 at t = 2 ("}},
    });
  }
}

TEST(oblique_walls, exist_for_the_kinds_that_say_so) {
  const auto gas = gas_of("bgk", 2);
  for (const apsis::boundary_entry* entry : apsis::boundary_entries()) {
    if (entry->name == "axis") {  // needs velocities on rings
      EXPECT_FALSE(entry->any_normal);
      continue;
    }
    apsis::face_quantities values;
    if (entry->variables != nullptr)
      for (const apsis::data_variable& variable : entry->variables(*gas))
        if (!variable.value && !values.contains(variable.alternative)) values[variable.name] = {1.0};
    const auto made = apsis::make_boundary(entry->name, *gas, values);
    EXPECT_EQ(made->oblique(gas->velocities()) != nullptr, entry->any_normal) << entry->name;
  }
}

TEST(oblique_walls, without_a_given_temperature_balance_heat_and_mass_of_any_row) {
  std::mt19937 generator(8);
  int unmatched = 0;
  for (const int d : {2, 3})
    for (const row_kind kind : {row_kind::positive, row_kind::decades, row_kind::few})
      for (const double alpha : {1.0, 0.6, 1e-3, 0.0})
        for (int n = 0; n < 5; ++n) {
          const auto gas = gas_of("bgk", d);
          const velocity_set set = gas->velocities();
          const vector normal = random_normal(d, generator);
          const auto inward = inward_of(set, normal);
          const auto f = random_row(kind, at(set.components()), generator);
          vector u = {-0.3 * normal[1], 0.3 * normal[0], 0.0};
          const std::vector<apsis::face_quantity> velocity(u.begin(), u.begin() + d);
          const auto made =
              apsis::make_boundary("adiabatic", *gas, {{"velocity", velocity}, {"accommodation", {alpha}}});
          std::vector<double> values(f.size(), 0.0), reflected(f.size());
          made->oblique(set)->emit({normal, {}, 0.0}, inward.data(), f.data(), values.data());
          unmatched += !apsis::oblique_reflection(set)
                            .reflect(normal, inward.data(), f.data(), reflected.data())
                            .is_matched;
          for (std::size_t k = 0; k < f.size(); ++k)
            if (inward[k] > 0.0) {
              EXPECT_GE(values[k], 0.0);
            }
          const auto heat = [&](const fluxes& all) {
            long double sum = all.sum[4] + all.sum[5];
            for (std::size_t k = 0; k < 3; ++k) sum += u[k] * (0.5L * u[k] * all.sum[0] - all.sum[1 + k]);
            return sum;
          };
          const auto arrives = fluxes_of(set, normal, inward, -1.0, f),
                     leaves = fluxes_of(set, normal, inward, 1.0, values);
          if (!(arrives.sum[0] > 0.0L)) continue;  // internal energy without molecules is no gas
          // The sums have a thousand terms. Other tests show that reflection matches its sums to 1e-14.
          EXPECT_LT(difference(arrives, leaves, true), 1e-13) << d << alpha;
          const long double size = arrives.size[4] + arrives.size[5];
          EXPECT_NEAR(static_cast<double>((heat(leaves) - heat(arrives)) / size), 0.0, 1e-13) << d << alpha;
        }
  EXPECT_GT(unmatched, 10);
}

TEST(oblique_walls, without_a_given_temperature_are_those_of_faces_at_a_normal_along_an_axis) {
  std::mt19937 generator(9);
  const auto gas = gas_of("bgk", 2);
  const velocity_set set = gas->velocities();
  const auto f = random_row(row_kind::positive, at(set.components()), generator);
  const apsis::face_quantities radiates = {{"sigma", {0.4}}, {"surroundings", {0.8}}, {"emissivity", {0.9}}};
  for (const auto& [kind, values] :
       {std::pair("adiabatic", apsis::face_quantities{}), std::pair("radiating", radiates)})
    for (const apsis::face where : {apsis::face{0, false}, apsis::face{0, true}, apsis::face{1, true}}) {
      const auto made = apsis::make_boundary(kind, *gas, values);
      vector normal{};
      normal[at(where.direction)] = where.upper ? -1.0 : 1.0;
      const auto inward = inward_of(set, normal);
      std::vector<double> at_face(f.size()), at_wall(f.size());
      made->prepared(where, set)->incoming(where, 0.0, {}, f.data(), at_face.data());
      made->oblique(set)->emit({normal, {}, 0.0}, inward.data(), f.data(), at_wall.data());
      for (std::size_t k = 0; k < f.size(); ++k)
        if (inward[k] > 0.0) {
          EXPECT_NEAR(at_wall[k], at_face[k], 1e-12 * at_face[k]) << kind;
        }
    }
}

TEST(oblique_walls, have_the_temperature_with_which_they_emit) {
  std::mt19937 generator(10);
  const auto gas = gas_of("bgk", 2);
  const velocity_set set = gas->velocities();
  const vector n = random_normal(2, generator);
  const auto inward = inward_of(set, n);
  const auto f = random_row(row_kind::positive, at(set.components()), generator);
  const auto sums = fluxes_of(set, n, inward, -1.0, f);
  apsis::arriving_gas arriving{
      static_cast<double>(sums.sum[0]), {}, static_cast<double>(sums.sum[4] + sums.sum[5])};
  // Only the momentum along the wall matters, because the wall moves along itself.
  for (std::size_t k = 0; k < 3; ++k) arriving.momentum[k] = static_cast<double>(sums.sum[1 + k]);
  const std::vector<apsis::face_quantity> velocity = {-0.4 * n[1], 0.4 * n[0]};
  const auto wall = apsis::make_boundary("radiating", *gas,
                                         {{"velocity", velocity}, {"sigma", {0.4}}, {"surroundings", {0.8}}});
  const apsis::wall_point where{n, {}, 0.0};
  const auto T = dynamic_cast<const apsis::wall_temperature&>(*wall).temperature(where, set, arriving);
  ASSERT_TRUE(T.has_value());
  const auto known = apsis::make_boundary("diffuse", *gas, {{"T", {*T}}, {"velocity", velocity}});
  EXPECT_EQ(dynamic_cast<const apsis::wall_temperature&>(*known).temperature(where, set, {}), *T);
  std::vector<double> found(f.size()), expected(f.size());
  wall->oblique(set)->emit(where, inward.data(), f.data(), found.data());
  known->oblique(set)->emit(where, inward.data(), f.data(), expected.data());
  for (std::size_t k = 0; k < f.size(); ++k)
    if (inward[k] > 0.0) {
      EXPECT_NEAR(found[k], expected[k], 1e-11 * expected[k]);
    }
  EXPECT_FALSE(dynamic_cast<const apsis::wall_temperature&>(*wall).temperature(where, set, {}).has_value());
}

TEST(oblique_walls, of_symmetry_need_the_components_of_a_gas) {
  const auto gas = gas_of("bgk", 2);
  EXPECT_EQ(apsis::make_boundary("symmetry")->oblique(gas->velocities()), nullptr);
  const auto entry = apsis::try_find_model("broadwell-plane");
  const auto other = entry->make(apsis::default_config(*entry));
  EXPECT_EQ(apsis::make_boundary("symmetry", *other)->oblique(other->velocities()), nullptr);
}

}  // namespace oblique_walls_test
