// Continuation in the amounts that enter at the ends: the incoming amounts, and starts from the last state.
#include <apsis/steady/milder_ends.hpp>

#include "gas_problem.hpp"

#include <apsis/core/errors.hpp>

#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace milder_ends_test {
namespace {

using apsis::milder_ends;
using testing::HasSubstr;

using row = std::vector<double>;

/// Returns a Maxwellian at rest.
row maxwellian(const apsis::relaxation_model& equation, double T) {
  row omega(static_cast<std::size_t>(equation.moment_count())),
      f(static_cast<std::size_t>(equation.components()));
  omega.front() = 1.0;
  omega.back() = 0.5 * equation.as_gas()->molecules().degrees_of_freedom() * T;
  EXPECT_TRUE(equation.equilibrium(omega.data(), f.data()));
  return f;
}

/// Returns the row that enters at the left end of a gas with the row `inside`.
row entering(const apsis::relaxation_model& equation, const apsis::boundary& of, const row& inside) {
  const apsis::velocity_set velocities = equation.velocities();
  const auto prepared = of.prepared({0, false}, velocities);  // nullptr if it needs no tables
  const apsis::boundary& side = prepared ? *prepared : of;
  row outgoing(inside), found(inside.size(), 0.0);
  const auto speeds = apsis::inward_speeds({0, false}, velocities);
  const std::size_t n = velocities.weights().size();
  for (std::size_t k = 0; k < outgoing.size(); ++k)
    if (speeds[k % n] > 0.0) outgoing[k] = 0.0;
  const std::vector<const double*> ghosts(3, inside.data());
  side.incoming_given_outgoing({0, false}, 0.0, {}, outgoing.data(), ghosts, found.data());
  for (std::size_t k = 0; k < found.size(); ++k)
    if (!(speeds[k % n] > 0.0)) found[k] = 0.0;
  return found;
}

/// The fluxes of mass and of the energy of the motion along x and of other degrees of freedom.
struct fluxes {
  double mass = 0.0, energy = 0.0;
};
fluxes fluxes_of(const apsis::relaxation_model& equation, const row& f) {
  const apsis::velocity_set& velocities = equation.velocities();
  const auto v = velocities.speeds(0), w = velocities.weights();
  fluxes found;
  for (std::size_t j = 0; j < w.size(); ++j) {
    found.mass += w[j] * v[j] * f[j];
    found.energy += 0.5 * w[j] * v[j] * (v[j] * v[j] * f[j] + f[w.size() + j]);
  }
  return found;
}

/// Returns a gas between walls of temperatures T and 1.
gas_problem heated(double delta, double T) {
  const auto equation = make_gas("bgk", 1, {4.0 * std::sqrt(T) + 4.0, 66}, 1);
  gas_problem gas = gas_between_walls(equation, 1, 40, delta);
  gas.space->with_boundary({0, false}, diffuse_wall(*equation, T))
      .with_boundary({0, true}, diffuse_wall(*equation, 1.0));
  return gas;
}

double mass(const gas_problem& gas, const apsis::field& f) {
  double sum = 0.0;
  std::vector<double> omega(static_cast<std::size_t>(gas.equation->moment_count()));
  for (int cell = 0; cell < f.cells(); ++cell) {
    gas.equation->moments(f.row(cell), omega.data());
    sum += omega[0];
  }
  return sum;
}

}  // namespace

TEST(milder_ends, emit_the_mass_of_a_wall_with_a_part_of_its_energy) {
  const auto equation = make_gas("bgk", 1, {12.0, 80}, 1);
  const row start = maxwellian(*equation, 1.0);
  const auto wall = diffuse_wall(*equation, 4.0);
  const auto row_of_start = std::make_shared<const row>(start);
  const fluxes whole = fluxes_of(*equation, entering(*equation, *wall, start)),
               none = fluxes_of(*equation, entering(*equation, *diffuse_wall(*equation, 1.0), start));
  for (const double share : {0.0, 0.25, 1.0}) {
    const auto milder = apsis::milder_end(wall, share, row_of_start);
    const fluxes some = fluxes_of(*equation, entering(*equation, *milder, start));
    EXPECT_NEAR(some.mass, whole.mass, 1e-14) << share;
    EXPECT_NEAR(some.energy, share * whole.energy + (1.0 - share) * none.energy, 1e-13) << share;
  }
  EXPECT_GT(whole.energy, 3.9 * none.energy);
}

TEST(milder_ends, let_in_the_mass_flux_of_every_kind_and_nothing_from_a_vacuum) {
  const auto equation = make_gas("bgk", 1, {9.0, 48}, 1);
  const row inside = maxwellian(*equation, 1.3);
  const auto start = std::make_shared<const row>(maxwellian(*equation, 0.8));
  const std::vector<std::pair<std::string, apsis::face_quantities>> kinds = {
      {"diffuse", {{"T", {2.0}}, {"accommodation", {0.7}}}},
      {"adiabatic", {}},
      {"inflow", {{"rho", {1.2}}, {"T", {1.5}}, {"u", {0.3}}}},
      {"far-field", {{"rho", {0.7}}, {"T", {1.5}}}},
      {"pressure", {{"p", {1.1}}}},
      {"mass-flow", {{"flux", {0.2}}}},
      {"vacuum", {}}};
  for (const auto& [kind, values] : kinds) {
    const std::shared_ptr<const apsis::boundary> side = apsis::make_boundary(kind, *equation, values);
    const row whole = entering(*equation, *side, inside),
              some = entering(*equation, *apsis::milder_end(side, 0.5, start), inside);
    EXPECT_NEAR(fluxes_of(*equation, some).mass, fluxes_of(*equation, whole).mass, 1e-13) << kind;
    for (const double f : some) EXPECT_GE(f, 0.0) << kind;
    if (kind == "vacuum")
      EXPECT_THAT(some, testing::Each(0.0));
    else
      EXPECT_NE(some, whole) << kind;
  }
}

TEST(milder_ends, are_possible_where_an_end_gives_what_enters) {
  const auto equation = make_gas("bgk", 1, {9.0, 24}, 1);
  gas_problem gas = gas_between_walls(equation, 1, 10, 1.0);
  EXPECT_FALSE(milder_ends::possible(*equation, *gas.space));  // periodic
  for (const bool upper : {false, true})
    gas.space->with_boundary({0, upper}, apsis::make_boundary("symmetry"));
  EXPECT_FALSE(milder_ends::possible(*equation, *gas.space));
  gas.space->with_boundary({0, true}, diffuse_wall(*equation, 2.0));
  EXPECT_TRUE(milder_ends::possible(*equation, *gas.space));
}

TEST(milder_ends, end_near_the_steady_state_with_the_mass_of_the_start) {
  const gas_problem gas = heated(1000.0, 30.0);
  gas.space->with_positivity_limiter();
  apsis::field f = gas.at_rest();
  milder_ends milder(*gas.equation, *gas.space, f, 3);
  EXPECT_THAT(milder.name(), HasSubstr("0.015625 to 0.5 of what enters"));
  int taken = 0;
  for (; !milder.finished(); ++taken) milder.iterate(f);
  EXPECT_LT(taken, 150);
  EXPECT_NEAR(mass(gas, f), mass(gas, gas.at_rest()), 1e-12 * 40);
  // Limited fluxes settle from the last of these states.
  const auto problem = gas.space->build();
  apsis::steady_solver solver(*gas.equation, *gas.space, *problem, gas.at_rest());
  apsis::field rest = gas.at_rest();
  static_cast<void>(solver.iterate(rest));  // sets the unit of residuals
  solver.restart(milder.damping());
  bool found = false;
  for (int k = 0; k < 150 && !found; ++k) found = solver.iterate(f).converged;
  EXPECT_TRUE(found);
}

TEST(milder_ends, that_do_not_settle_say_so) {
  // Only walls take the heat of the source, and it does not reach them in a hundred iterations.
  const auto equation = make_gas("bgk", 1, {12.0, 24}, 1);
  gas_problem gas = gas_between_walls(equation, 1, 20, 500.0);
  gas.space->with_boundary({0, false}, apsis::make_boundary("symmetry"))
      .with_boundary({0, true}, apsis::make_boundary("adiabatic", *equation, {}));
  gas.space->with_source({[](double, const apsis::position&, std::span<const double>, std::span<double> f) {
                            f[11] = f[12] = 1.0;
                          },
                          true});
  apsis::field f = gas.at_rest();
  milder_ends milder(*gas.equation, *gas.space, f, 3);
  EXPECT_THROW(
      {
        while (!milder.finished()) milder.iterate(f);
      },
      apsis::numerical_error);
}

}  // namespace milder_ends_test
