// Gases past bodies in the plane and in space, with many settings.
#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace gas_past_bodies_test {

using apsis::field;
using apsis::grid;
using apsis::outside_function;
using apsis::position;

inline outside_function ball(position centre, double r) {
  return [=](const position& at) {
    return std::hypot(at[0] - centre[0], at[1] - centre[1], at[2] - centre[2]) - r;
  };
}

inline outside_function either(const outside_function& a, const outside_function& b) {
  return [=](const position& at) { return std::min(a(at), b(at)); };
}

/// A gas past bodies in a square or cube of side 2.
struct gas_past_bodies {
  std::shared_ptr<const apsis::relaxation_model> equation;
  std::unique_ptr<apsis::problem_builder> builder;
  std::unique_ptr<apsis::semidiscrete_problem> problem;

  const grid& mesh() const { return builder->mesh(); }
  /// Returns the Maxwellian with density 1, temperature 1 and this velocity in each cell.
  field uniform(double ux = 0.0) const {
    const auto count = static_cast<std::size_t>(equation->moment_count());
    std::vector<double> omega(count, 0.0);
    omega[0] = 1.0;
    omega[1] = ux;
    omega.back() = 0.5 * equation->as_gas()->molecules().degrees_of_freedom() + 0.5 * ux * ux;
    field f(mesh().size(), equation->components());
    for (int cell = 0; cell < f.cells(); ++cell)
      if (mesh().solid(cell) < 0) equation->equilibrium(omega.data(), f.row(cell));
    return f;
  }
  /// Returns α u + β T(u).
  field step(const field& u, double alpha, double beta) const {
    field acc(u.cells(), u.components());
    const apsis::target<field, double> to{&acc, alpha, beta, true};
    problem->add_transport(0.0, u, {&to, 1});
    return acc;
  }
};

struct choices {
  int dimensions = 2, cells = 20;
  std::vector<outside_function> bodies = {};
  std::string model = "bgk", scheme = "weno5-z", boundary = "periodic";
  bool limited = true;
  double wall_temperature = 1.0;
  std::vector<apsis::face_quantity> wall_velocity = {};
  std::string wall = "diffuse";
  apsis::face_quantity accommodation = 1.0;
  double epsilon = 1.0;
  apsis::face_quantities boundary_values = {};  ///< values of `boundary`, if it has variables
};

/// Makes a gas on a mesh that `processes` share, or that a single process has.
inline gas_past_bodies make(const choices& of,
                            const std::shared_ptr<apsis::communicator>& processes = nullptr,
                            const std::optional<std::array<int, 3>>& blocks = std::nullopt) {
  const int d = of.dimensions;
  auto config = apsis::default_config(apsis::find_model(of.model));
  config.space_dimensions = d;
  config.velocity = {4.0, d == 2 ? 10 : 6};
  config.parameters["velocity_dimensions"] = d;
  config.parameters["degrees_of_freedom"] = 3;
  const std::shared_ptr<const apsis::model> made = apsis::find_model(of.model).make(config);
  gas_past_bodies gas{{made, made->as_relaxation()}, nullptr, nullptr};
  gas.builder = std::make_unique<apsis::problem_builder>(*gas.equation);
  const bool is_periodic = of.boundary == "periodic";
  const grid plain(d, {of.cells, of.cells, d > 2 ? of.cells : 1}, {-1, -1, -1}, {1, 1, 1});
  const grid mesh = plain.with_cut_cells(std::make_shared<apsis::cut_cells>(
      plain, of.bodies, std::array{is_periodic, is_periodic, is_periodic}));
  gas.builder->on(mesh)
      .with_discretization("finite-difference")
      .with_reconstruction(apsis::find_reconstruction(of.scheme).make())
      .with_epsilon([epsilon = of.epsilon](const position&) { return epsilon; });
  if (processes) gas.builder->shared_by(processes, blocks);
  if (of.limited) gas.builder->with_positivity_limiter();
  for (std::size_t k = 0; !is_periodic && k < 2 * static_cast<std::size_t>(d); ++k)
    gas.builder->with_boundary(apsis::face_of(k),
                               apsis::find_boundary(of.boundary).variables == nullptr
                                   ? apsis::make_boundary(of.boundary)
                                   : apsis::make_boundary(of.boundary, *gas.equation, of.boundary_values));
  apsis::face_quantities wall{{"T", {of.wall_temperature}}, {"accommodation", {of.accommodation}}};
  if (of.wall != "diffuse") wall.clear();
  if (!of.wall_velocity.empty()) wall["velocity"] = of.wall_velocity;
  for (int body = 0; body < mesh.obstacles(); ++body)
    gas.builder->with_solid(body, apsis::make_boundary(of.wall, *gas.equation, wall));
  gas.problem = gas.builder->build();
  return gas;
}

inline double largest(const field& u) {
  double most = 0.0;
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k) most = std::max(most, std::abs(u.row(cell)[k]));
  return most;
}

inline double least_value(const field& u) {
  double least = 1e300;
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k) least = std::min(least, u.row(cell)[k]);
  return least;
}

/// Returns values over ten decades, with exact zeros. Cells of a group have equal values.
inline field random_state(const grid& mesh, int components, std::mt19937& generator) {
  std::uniform_real_distribution<double> exponent(-10.0, 0.0), choice(0.0, 1.0);
  field f(mesh.size(), components);
  for (int cell = 0; cell < f.cells(); ++cell) {
    if (mesh.solid(cell) >= 0) continue;
    const int group = mesh.cut_group(cell);
    const int first = group < 0 ? cell : mesh.cut()->groups()[apsis::at(group)].cells.front();
    for (int k = 0; k < components; ++k)
      f.row(cell)[k] = first < cell              ? f.row(first)[k]
                       : choice(generator) < 0.2 ? 0.0
                                                 : std::pow(10.0, exponent(generator));
  }
  return f;
}

/// Returns the sums of the densities of the invariants times the volume of gas.
inline std::vector<double> integrals(const gas_past_bodies& gas, const field& u) {
  const std::size_t count = gas.equation->invariants().size();
  std::vector<double> sum(count), here(count);
  for (int cell = 0; cell < u.cells(); ++cell) {
    gas.equation->invariant_densities(u.row(cell), here.data());
    for (std::size_t k = 0; k < count; ++k)
      sum[k] += here[k] * gas.mesh().gas_share(cell) * gas.mesh().cell_volume();
  }
  return sum;
}

/// Returns moments of a gas with waves. Cells of a group have equal moments.
inline std::vector<double> some_moments(const gas_past_bodies& gas, double phase) {
  std::vector<double> omega;
  const int directions = gas.equation->velocities().dimensions();
  for (int cell = 0; cell < gas.mesh().size(); ++cell) {
    const position x = gas.mesh().centre(cell);
    const double rho = 1.0 + 0.2 * std::sin(3.0 * x[0] + x[1] + phase),
                 T = 1.0 + 0.1 * std::cos(2.0 * x[1] + phase);
    double square = 0.0;
    omega.push_back(rho);
    for (int k = 0; k < directions; ++k) {
      const double u = 0.2 * std::sin(x[0] - x[1] + k + phase);
      omega.push_back(rho * u);
      square += u * u;
    }
    omega.push_back(0.5 * rho * (gas.equation->as_gas()->molecules().degrees_of_freedom() * T + square));
  }
  return omega;
}

inline std::vector<choices> some_flows() {
  const std::vector<outside_function> discs = {ball({0.21, 0.13, 0}, 0.4), ball({-0.32, -0.2, 0}, 0.45)};
  return {{.bodies = discs},
          {.bodies = discs, .boundary = "outflow"},
          {.bodies = {ball({-0.95, 0.03, 0}, 0.41)}, .boundary = "diffuse"},
          {.bodies = {ball({0.07, -1.0, 0}, 0.5)}, .boundary = "symmetry"},
          {.bodies = {either(ball({0.07, -1.0, 0}, 0.5), ball({0.07, 1.0, 0}, 0.5))}, .scheme = "upwind5"},
          {.bodies = discs, .scheme = "upwind1"},
          {.bodies = discs, .limited = false},
          {.bodies = discs, .model = "es-bgk"},
          {.bodies = discs, .accommodation = 0.5},
          {.bodies = discs, .limited = false, .accommodation = 0.0},
          {.bodies = discs, .wall = "symmetry"},
          {.bodies = discs, .model = "es-bgk", .boundary = "outflow", .wall = "symmetry"},
          {.dimensions = 3, .cells = 12, .bodies = {ball({0.1, -0.05, 0.03}, 0.55)}, .wall = "symmetry"},
          {.dimensions = 3, .cells = 12, .bodies = {ball({0.1, -0.05, 0.03}, 0.55)}, .accommodation = 0.5},
          {.dimensions = 3, .cells = 12, .bodies = {ball({0.1, -0.05, 0.03}, 0.55)}},
          {.dimensions = 3, .cells = 12, .bodies = {ball({0.1, -0.05, 1.0}, 0.55)}, .boundary = "diffuse"}};
}

}  // namespace gas_past_bodies_test
