// Boundaries that prescribe the incoming components: walls and inflow.
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/model/model_registry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>
#include <support/property.hpp>

namespace walls_test {

namespace {

using apsis::face;
using apsis::face_quantities;
using apsis::face_quantity;
using apsis::make_boundary;
using apsis::position;

std::unique_ptr<apsis::model> gas_of(int dimensions, int degrees, int points = 24) {
  auto parts = apsis::default_config(apsis::find_model("bgk"));
  parts.parameters["velocity_dimensions"] = dimensions;
  parts.parameters["degrees_of_freedom"] = degrees;
  parts.velocity.max = 7.0;
  parts.velocity.points = points;
  return apsis::find_model("bgk").make(parts);
}

/// Returns a wall with its tables for a face.
std::shared_ptr<const apsis::boundary> wall(const apsis::model& gas, const face& where,
                                            const face_quantities& values) {
  return make_boundary("diffuse", gas, values)->prepared(where, gas.velocities());
}

/// Returns random outgoing components; all others are 0.
std::vector<double> random_outgoing(const apsis::model& gas, const face& where) {
  std::vector<double> f(static_cast<std::size_t>(gas.components()));
  const auto enters = apsis::entering_components(where, gas.velocities());
  for (std::size_t k = 0; k < f.size(); ++k)
    if (enters[k] == 0.0) f[k] = *rc::gen::inRange(0, 1000) / 999.0;
  return f;
}

/// Returns the fluxes of the invariants through the face, Σ φ_j v_j f_j.
std::vector<double> fluxes(const apsis::model& gas, const std::vector<double>& f) {
  std::vector<double> moving = f, sums(gas.invariants().size());
  for (std::size_t k = 0; k < f.size(); ++k) moving[k] *= gas.speeds(0)[k];
  gas.invariant_densities(moving.data(), sums.data());
  return sums;
}

}  // namespace

RC_GTEST_PROP(diffuse_wall, no_mass_crosses_and_everything_emitted_is_nonnegative, ()) {
  const int d = *rc::gen::inRange(1, 4), degrees = *rc::gen::element(0, 3, 5);
  const auto gas = gas_of(d, degrees == 0 ? 0 : std::max(degrees, d), d == 3 ? 12 : 16);
  const face where{0, *rc::gen::arbitrary<bool>()};
  face_quantities values = {{"T", {*rc::gen::inRange(60, 150) / 100.0}},
                            {"accommodation", {*rc::gen::inRange(0, 11) / 10.0}}};
  if (d > 1) values["velocity"] = {0.0, *rc::gen::inRange(-50, 50) / 100.0};
  if (d == 3) values["velocity"].emplace_back(0.25);
  const std::vector<double> leaving = random_outgoing(*gas, where);
  std::vector<double> all = leaving;
  const auto enters = apsis::entering_components(where, gas->velocities());
  std::vector<double> entering(leaving.size());
  wall(*gas, where, values)->incoming(where, 0.0, {}, leaving.data(), entering.data());
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (enters[k] == 0.0) continue;
    RC_ASSERT(entering[k] >= 0.0);
    all[k] = entering[k];
  }
  // The error is relative to the mass that arrives, a sum of at most 2000 numbers of one sign.
  RC_ASSERT(std::abs(fluxes(*gas, all)[0]) <= 1e-14 * std::abs(fluxes(*gas, leaving)[0]));
}

TEST(diffuse_wall, re_emits_the_equilibrium_that_arrives) {
  // A gas at rest in equilibrium with the wall does not change.
  for (const int degrees : {0, 3}) {
    const auto gas = gas_of(1, degrees);
    std::vector<double> f(static_cast<std::size_t>(gas->components()));
    gas->data_forms().front().row(std::array{0.7, 0.0, 1.3}, f);
    std::vector<double> leaving = f, entering(f.size());
    const face where{0, false};
    const auto enters = apsis::entering_components(where, gas->velocities());
    for (std::size_t k = 0; k < f.size(); ++k)
      if (enters[k] != 0.0) leaving[k] = 0.0;
    wall(*gas, where, {{"T", {1.3}}})->incoming(where, 0.0, {}, leaving.data(), entering.data());
    for (std::size_t k = 0; k < f.size(); ++k)
      if (enters[k] != 0.0) {
        EXPECT_NEAR(entering[k], f[k], 1e-14 * f[k]) << k;
      }
  }
}

TEST(diffuse_wall, reflects_without_accommodation_and_mixes_with_a_part) {
  const auto gas = gas_of(1, 0);
  const face where{0, true};
  std::vector<double> leaving(24), specular(24), diffuse(24), mixed(24);
  for (std::size_t k = 12; k < 24; ++k) leaving[k] = static_cast<double>(k);
  const auto emit = [&](double accommodation, std::vector<double>& f) {
    wall(*gas, where, {{"accommodation", {accommodation}}})
        ->incoming(where, 0.0, {}, leaving.data(), f.data());
  };
  emit(0.0, specular);
  emit(1.0, diffuse);
  emit(0.25, mixed);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_EQ(specular[k], leaving[23 - k]);
    EXPECT_NEAR(mixed[k], 0.75 * specular[k] + 0.25 * diffuse[k], 1e-14 * mixed[k]);
  }
}

TEST(diffuse_wall, follows_its_values_in_time) {
  const auto gas = gas_of(2, 3);
  const face where{0, false};
  const auto temperature = [](double t, const position&) { return 1.0 + 0.5 * t; };
  const auto moving = wall(*gas, where, {{"T", {face_quantity(temperature)}}, {"velocity", {0.0, 0.2}}});
  const auto fixed = wall(*gas, where, {{"T", {1.2}}, {"velocity", {0.0, 0.2}}});
  const std::vector<double> leaving(static_cast<std::size_t>(gas->components()), 1.0);
  std::vector<double> a(leaving.size()), b(leaving.size());
  moving->incoming(where, 0.4, {}, leaving.data(), a.data());
  fixed->incoming(where, 7.0, {}, leaving.data(), b.data());
  EXPECT_EQ(a, b);
}

TEST(diffuse_wall, values_that_no_wall_has_are_refused) {
  const auto gas = gas_of(2, 3);
  const face where{0, false};
  std::vector<double> f(static_cast<std::size_t>(gas->components()), 1.0);
  const auto evaluate = [&](const face_quantities& values) {
    wall(*gas, where, values)->incoming(where, 0.5, {}, f.data(), f.data());
  };
  EXPECT_NO_THROW(evaluate({}));
  bad_input::expect_refused({
      {[&] { evaluate({{"velocity", {0.1, 0.0}}}); },
       {"the velocity of a wall is 0.1 along its normal at t = 0.5 near (0, 0) ("}},
      {[&] { evaluate({{"accommodation", {1.5}}}); },
       {"the accommodation of a diffuse wall is 1.5 at t = 0.5 (a number from 0 to 1"}},
      {[&] { evaluate({{"T", {-1.0}}}); }, {"the boundary has no Maxwellian at t = 0 ("}},
      {[&] { evaluate({{"T", {face_quantity([](double t, const position&) { return -t; })}}}); },
       {"the boundary has no Maxwellian at t = 0.5 ("}},
      {[&] { evaluate({{"temperature", {1.0}}}); }, {"boundary 'diffuse' has no variable 'temperature'"}},
      {[&] { evaluate({{"velocity", {0.0, 0.1, 0.2}}}); },
       {"'velocity' of boundary 'diffuse' has 3 components (the model has 2); give 2"}},
      {[&] { make_boundary("inflow", *gas, {{"T", {1.0}}}); }, {"boundary 'inflow' has no value of 'rho'"}},
      {[&] { make_boundary("diffuse"); }, {"boundary 'diffuse' needs a model"}},
  });
  const auto broadwell = apsis::try_find_model("broadwell");
  const auto other = broadwell->make(apsis::default_config(*broadwell));
  bad_input::expect_refused({
      {[&] { make_boundary("diffuse", *other); },
       {"boundary 'diffuse' cannot be used (the model has no Maxwellians)"}},
  });
}

TEST(vacuum, lets_nothing_enter) {
  for (const char* name : {"bgk", "broadwell", "broadwell-plane"}) {
    const auto entry = apsis::try_find_model(name);
    const auto gas = entry->make(apsis::default_config(*entry));
    for (const bool upper : {false, true}) {
      const face where{0, upper};
      const auto boundary = make_boundary("vacuum", *gas)->prepared(where, gas->velocities());
      std::vector<double> f(static_cast<std::size_t>(gas->components()), 3.0), leaving = f;
      boundary->incoming(where, 0.0, {}, leaving.data(), f.data());
      const auto enters = apsis::entering_components(where, gas->velocities());
      for (std::size_t k = 0; k < f.size(); ++k)
        if (enters[k] != 0.0) {
          EXPECT_EQ(f[k], 0.0);
        }
      EXPECT_TRUE(boundary->prescribes_incoming(9, 3));
      EXPECT_FALSE(boundary->entropy_bound().has_value());
    }
  }
  const auto relaxation = apsis::try_find_model("relaxation");
  const auto law = relaxation->make(apsis::default_config(*relaxation));
  bad_input::expect_refused({
      {[&] { make_boundary("vacuum", *law); },
       {"boundary 'vacuum' cannot be used (the components of the model are not densities of "
        "particles)"}},
  });
}

TEST(inflow, enters_whatever_leaves) {
  const auto gas = gas_of(1, 3);
  const face where{0, true};
  const std::size_t n = static_cast<std::size_t>(gas->components());
  std::vector<double> state(n), a(n), leaving(n, 3.0);
  gas->data_forms().front().row(std::array{0.5, -0.3, 0.8}, state);
  const auto inflow = make_boundary("inflow", *gas, {{"rho", {0.5}}, {"u", {-0.3}}, {"T", {0.8}}});
  inflow->incoming(where, 0.0, {}, leaving.data(), a.data());
  const auto enters = apsis::entering_components(where, gas->velocities());
  for (std::size_t k = 0; k < n; ++k)
    if (enters[k] != 0.0) {
      EXPECT_EQ(a[k], state[k]);
    }
}

namespace {

/// Returns ghost rows of two components, which move with −1 and 1, beyond the lower face.
std::vector<std::array<double, 2>> ghosts_of(const std::vector<std::array<double, 2>>& cells) {
  class nothing final : public apsis::incoming_boundary {
   public:
    void incoming(const face&, double, const position&, const double*, double*) const override {}
  };
  const apsis::velocity_set v({{-1.0, 1.0}}, {1.0, 1.0});
  std::vector<std::array<double, 2>> ghosts(3);
  std::vector<const double*> inside;
  std::vector<double*> beyond;
  for (const auto& cell : cells) inside.push_back(cell.data());
  for (auto& ghost : ghosts) beyond.push_back(ghost.data());
  nothing().fill({0, false}, 0.0, {inside, beyond, v, 2, {}});
  return ghosts;
}

}  // namespace

TEST(incoming_boundary, continues_quadratics_exactly) {
  // Averages of f = 1 + 0.03 x + 0.02 x² over cells of width 0.1, inwards from the face. `left` is in units
  // of this width. The boundary keeps a share 1 − y² of the continuation. Here y is about 1e-10, so y² is
  // below rounding.
  const auto average = [](double left) {
    const double right = left + 1.0;
    return 1.0 + 0.0015 * (right * right - left * left) +
           0.0002 / 3.0 * (right * right * right - left * left * left);
  };
  std::vector<std::array<double, 2>> cells;
  for (int i = 0; i < 5; ++i) cells.push_back({average(i), 2.0 * average(i)});
  const auto ghosts = ghosts_of(cells);
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    EXPECT_NEAR(ghosts[g][0], average(-static_cast<double>(g) - 1.0), 1e-13) << g;
    EXPECT_NEAR(ghosts[g][1], 2.0 * average(-static_cast<double>(g) - 1.0), 1e-13) << g;
  }
}

TEST(incoming_boundary, does_not_continue_a_jump_inside) {
  for (const int at : {1, 2}) {
    std::vector<std::array<double, 2>> cells(4);
    for (int i = 0; i < 4; ++i) cells[static_cast<std::size_t>(i)] = {i < at ? 1.0 : 9.0, 9.0};
    for (const auto& ghost : ghosts_of(cells)) {
      // The quadratic would be 1 ± 72. A jump of 8 from the value 1 keeps a share 2 (1/16)⁴ of it.
      EXPECT_NEAR(ghost[0], 1.0, 3e-3) << at;
      EXPECT_EQ(ghost[1], 9.0);
    }
    // A jump from a vacuum keeps no share.
    for (int i = 0; i < 4; ++i) cells[static_cast<std::size_t>(i)] = {i < at ? 1e-12 : 1.0, 0.0};
    for (const auto& ghost : ghosts_of(cells)) EXPECT_EQ(ghost, (std::array{1e-12, 0.0})) << at;
  }
}

TEST(incoming_boundary, continues_any_data_by_finite_numbers_that_scale_with_them) {
  check_property("data of every size", [] {
    const auto number = [] { return *rc::gen::element(0.0, 1.0, -1.0, 0.25, 7.0) * *rc::gen::inRange(0, 9); };
    const std::vector<std::array<double, 2>> cells = {{number(), 1.0}, {number(), 1.0}, {number(), 1.0}};
    const auto ghosts = ghosts_of(cells);
    for (const int exponent : {-1060, -1022, -400, 400, 1000}) {
      auto scaled = cells;
      for (auto& cell : scaled) cell[0] = std::ldexp(cell[0], exponent);
      const auto of_scaled = ghosts_of(scaled);
      for (std::size_t g = 0; g < ghosts.size(); ++g) {
        RC_ASSERT(std::isfinite(of_scaled[g][0]));
        // Subnormal numbers are multiples of 2^-1074, and some operations have errors of this size. The share
        // depends on the data, which exceed 2^-1063, by 2^-9 of such an error.
        const double expected = std::ldexp(ghosts[g][0], exponent);
        RC_ASSERT(std::abs(of_scaled[g][0] - expected) <=
                  1e-13 * std::abs(expected) + std::ldexp(exponent < -1000 ? 1e4 : 0.0, -1074));
      }
    }
    // The share is at most 1, so the continuation deviates no more than the quadratic.
    for (std::size_t g = 0; g < ghosts.size(); ++g) {
      const double n = static_cast<double>(g) + 1.0, a0 = cells[0][0], s = a0 - cells[1][0],
                   c = s - (cells[1][0] - cells[2][0]), quadratic = n * (s + 0.5 * (n + 1.0) * c);
      RC_ASSERT(std::abs(ghosts[g][0] - a0) <= (1.0 + 1e-14) * std::abs(quadratic) + 1e-13);
    }
  });
}

TEST(incoming_boundary, is_a_smooth_function_of_the_cells) {
  // Differences along lines through the data approximate second derivatives. At a kink they would
  // grow as 1/h.
  const auto steepest = [](double a1, double a2, double d0, double d1, double h) {
    const auto ghost = [&](double x) {
      return ghosts_of({{1.0 + d0 * x, 0.0}, {a1 + d1 * x, 0.0}, {a2, 0.0}})[0][0];
    };
    double most = 0.0;
    for (double x = -0.5; x < 0.5; x += 0.3 * h)
      most = std::max(most, std::abs(ghost(x - h) - 2.0 * ghost(x) + ghost(x + h)) / (h * h));
    return most;
  };
  for (const auto& [a1, a2, d0, d1] :
       std::vector<std::array<double, 4>>{{1, 1, 1, 0}, {1, 0.7, 1, 0}, {1, 0.7, 0, 1}, {1.4, 0.2, 1, -1}}) {
    const double coarse = steepest(a1, a2, d0, d1, 1e-2), fine = steepest(a1, a2, d0, d1, 1e-3);
    EXPECT_LT(fine, 1.2 * coarse + 1e-6) << a1 << " " << a2 << " " << d0 << " " << d1;
  }
}

}  // namespace walls_test
