#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

/// A gas in a box, and the problem that describes it.
struct gas_problem {
  std::shared_ptr<const apsis::relaxation_model> equation;
  std::shared_ptr<apsis::problem_builder> space;

  /// Returns a gas at rest of density and temperature 1.
  apsis::field at_rest() const {
    const std::size_t count = static_cast<std::size_t>(equation->moment_count());
    std::vector<double> omega(count, 0.0);
    omega.front() = 1.0;
    omega.back() = 0.5 * equation->as_gas()->molecules().degrees_of_freedom();
    apsis::field f(space->mesh().size(), equation->components());
    for (int cell = 0; cell < f.cells(); ++cell) equation->equilibrium(omega.data(), f.row(cell));
    return f;
  }
};

inline std::shared_ptr<const apsis::relaxation_model> make_gas(const std::string& name, int space,
                                                               const apsis::velocity_config& velocity,
                                                               int velocity_dimensions) {
  auto config = apsis::default_config(apsis::find_model(name));
  config.space_dimensions = space;
  config.velocity = velocity;
  config.parameters["velocity_dimensions"] = velocity_dimensions;
  config.parameters["degrees_of_freedom"] = 3;
  config.parameters["viscosity_exponent"] = 0.5;
  config.options["collision_rate"] = "viscosity";
  std::shared_ptr<const apsis::model> made = apsis::find_model(name).make(config);
  return {made, made->as_relaxation()};
}

/// Returns a gas of rarefaction parameter δ between walls on all sides of the unit box.
inline gas_problem gas_between_walls(std::shared_ptr<const apsis::relaxation_model> equation, int dimensions,
                                     int cells, double delta, const std::string& scheme = "upwind5") {
  gas_problem made;
  made.equation = std::move(equation);
  made.space = std::make_shared<apsis::problem_builder>(*made.equation);
  const int y = dimensions > 1 ? cells : 1, z = dimensions > 2 ? cells : 1;
  made.space->on({dimensions, {cells, y, z}, {0, 0, 0}, {1, 1, 1}})
      .with_discretization("finite-difference")
      .with_reconstruction(apsis::find_reconstruction(scheme).make())
      .with_epsilon([delta](const apsis::position&) { return 1.0 / (std::sqrt(2.0) * delta); });
  return made;
}

/// Returns a diffuse wall of a temperature that moves with u along y. `u` must be 0 if the gas has
/// no such velocity.
inline std::shared_ptr<const apsis::boundary> diffuse_wall(const apsis::model& equation, double T,
                                                           double u = 0.0) {
  apsis::face_quantities values{{"T", {T}}};
  if (const int d = equation.velocities().dimensions(); d > 1) {
    values["velocity"].assign(static_cast<std::size_t>(d), 0.0);
    values["velocity"][1] = u;
  }
  return apsis::make_boundary("diffuse", equation, values);
}
