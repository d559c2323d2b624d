// A gas in axisymmetric flow with velocities on rings around an axis.
#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/index.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/model/model.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace polar_gas_test {

using apsis::at;
using apsis::field;
using apsis::grid;
using apsis::position;

/// Velocities on rings × angles × a line along the axis, with weights v_⊥ of a ring. Mesh directions are r,
/// or x and r. For D = 1 the velocities are (v_r, v_θ, v_x), for D = 2 (v_x, v_r, v_θ).
class polar_gas final : public apsis::relaxation_model {
 public:
  polar_gas(int dimensions, std::vector<double> speeds, int angles, std::vector<double> along,
            bool by_density = false)
      : dimensions_(dimensions),
        by_density_(by_density),
        layout_{static_cast<int>(speeds.size()), angles, static_cast<int>(along.size()), std::move(speeds)} {
    std::vector<apsis::aligned_vector<double>> v(3);
    std::vector<double> weights;
    for (const double speed : layout_.speeds)
      for (int a = 0; a < angles; ++a)
        for (const double vx : along) {
          v[at(radial())].push_back(speed * cosine(a));
          v[at(radial() + 1)].push_back(speed * cosine(a - angles / 4));
          v[at(dimensions == 1 ? 2 : 0)].push_back(vx);
          weights.push_back(speed);
        }
    velocities_ = {std::move(v), std::move(weights)};
  }

  int radial() const { return dimensions_ - 1; }
  int components() const override { return layout_.size(); }
  int space_dimensions() const override { return dimensions_; }
  const apsis::velocity_set& velocities() const override { return velocities_; }
  apsis::polar_layout polar() const override { return layout_; }
  bool rate_is_proportional_to_density() const override { return by_density_; }
  bool positive() const override { return true; }
  double v(int direction, int k) const { return velocities_.speeds(direction)[at(k)]; }
  double v_r(int k) const { return v(radial(), k); }
  double v_theta(int k) const { return v(radial() + 1, k); }
  double v_x(int k) const { return v(dimensions_ == 1 ? 2 : 0, k); }
  double perpendicular(int k) const { return layout_.speeds[at(k / (layout_.angles * layout_.apart))]; }

  int moment_count() const override { return 1; }
  void moments(const double* u, double* omega) const override {
    omega[0] = 0.0;
    for (int k = 0; k < components(); ++k) omega[0] += velocities_.weights()[at(k)] * u[k];
  }
  bool equilibrium(const double* omega, double* e) const override {
    double sum = 0.0;
    for (const double w : velocities_.weights()) sum += w;
    std::fill_n(e, components(), omega[0] / sum);
    return true;
  }
  double rate(const double* omega) const override { return by_density_ ? omega[0] : 1.0; }
  std::string why_inadmissible(const double*) const override { return ""; }
  std::vector<std::string> invariants() const override {
    return {"mass", "radial momentum", "azimuthal momentum", "axial momentum", "energy"};
  }
  void invariant_densities(const double* u, double* densities) const override {
    std::fill_n(densities, 5, 0.0);
    for (int k = 0; k < components(); ++k) {
      const double f = velocities_.weights()[at(k)] * u[k],
                   squares = perpendicular(k) * perpendicular(k) + v_x(k) * v_x(k);
      const std::array<double, 5> of = {1.0, v_r(k), v_theta(k), v_x(k), 0.5 * squares};
      for (std::size_t i = 0; i < of.size(); ++i) densities[i] += of[i] * f;
    }
  }
  std::vector<apsis::field_group> fields() const override { return {}; }
  const std::vector<apsis::initial_data>& initial() const override {
    static const std::vector<apsis::initial_data> none;
    return none;
  }
  /// Returns the Maxwellian by its formula.
  std::vector<apsis::data_form> data_forms() const override {
    const auto row = [this](std::span<const double> values, std::span<double> u) -> std::string {
      for (int k = 0; k < components(); ++k) {
        double square = 0.0;
        for (int d = 0; d < 3; ++d) square += (v(d, k) - values[at(d + 1)]) * (v(d, k) - values[at(d + 1)]);
        u[at(k)] = values[0] * std::exp(-0.5 * square / values[4]);
      }
      return "";
    };
    return {{"Maxwellian", {{"rho", "density"}, {"u", "velocity", 3, 0.0}, {"T", "temperature"}}, row}};
  }

 private:
  /// Returns cos ω_a from angles of the first quadrant, so that images are exact.
  double cosine(int a) const {
    const int m = layout_.angles, turned = (a % m + m) % m, folded = turned < m / 2 ? turned : m - 1 - turned,
              quarter = folded < m / 4 ? folded : m / 2 - 1 - folded;
    const double value = std::cos((quarter + 0.5) * 2.0 * std::numbers::pi / m);
    return folded < m / 4 ? value : -value;
  }

  int dimensions_;
  bool by_density_;
  apsis::polar_layout layout_;
  apsis::velocity_set velocities_;
};

/// Settings of a flow in 0 ≤ x ≤ 1 and r ≥ `inner`.
struct choices {
  int dimensions = 1, cells = 12, angles = 16;
  std::vector<double> speeds = {0.6, 1.3}, along = {-1.1, -0.4, 0.4, 1.1};
  double inner = 0.0, length = 1.2;  ///< range of r
  std::string scheme = "upwind5";
  bool limited = false;
  std::string outer = "diffuse", ends = "periodic";
  apsis::outside_function body = {};
  std::optional<apsis::cell_box> box = {};
  bool by_density = false;
  double speed = 0.0;  ///< speed of walls and gases beyond the ends, along the axis
};

struct polar_flow {
  std::shared_ptr<const polar_gas> equation;
  std::unique_ptr<apsis::problem_builder> builder;
  std::unique_ptr<apsis::semidiscrete_problem> problem;

  const grid& mesh() const { return builder->mesh(); }
  double r(int cell) const { return mesh().centre(cell)[at(equation->radial())]; }
  /// Returns α u + β T(u).
  field step(const field& u, double alpha, double beta) const {
    field acc(u.cells(), u.components());
    const apsis::target<field, double> to{&acc, alpha, beta, true};
    problem->add_transport(0.0, u, {&to, 1});
    return acc;
  }
  /// Returns r times the Maxwellian of temperature 1 with this velocity along the axis.
  field stream(double speed) const {
    const auto form = equation->data_forms().front();
    std::array values{1.0, 0.0, 0.0, 0.0, 1.0};
    values[equation->radial() == 0 ? 3 : 1] = speed;
    return builder->sample([&](const position&, std::span<double> f) { form.row(values, f); });
  }
  /// Returns the same at rest, as walls emit it.
  field at_rest() const { return stream(0.0); }
};

/// Returns a boundary whose wall or gas beyond the end has this velocity along the axis.
inline std::shared_ptr<const apsis::boundary> side(const std::string& kind, const polar_gas& gas,
                                                   double speed = 0.0) {
  std::vector<apsis::face_quantity> u(3, 0.0);
  u[gas.radial() == 0 ? 2 : 0] = speed;
  if (kind == "diffuse") return apsis::make_boundary(kind, gas, {{"T", {1.0}}, {"velocity", u}});
  if (kind == "inflow") return apsis::make_boundary(kind, gas, {{"rho", {1.0}}, {"u", u}, {"T", {1.0}}});
  return apsis::make_boundary(kind, gas);
}

inline polar_flow make(const choices& of, const std::shared_ptr<apsis::communicator>& processes = nullptr,
                       const std::optional<std::array<int, 3>>& blocks = std::nullopt) {
  polar_flow flow{std::make_shared<polar_gas>(of.dimensions, of.speeds, of.angles, of.along, of.by_density),
                  nullptr, nullptr};
  const int radial = flow.equation->radial();
  const double outer = of.inner + of.length;
  grid mesh = radial == 0 ? grid::line(of.cells, of.inner, outer)
                          : grid(2, {of.cells, of.cells, 1}, {0.0, of.inner, 0.0}, {1.0, outer, 1.0});
  if (of.box) mesh = mesh.with_solids({*of.box});
  if (of.body)
    mesh = mesh.with_cut_cells(std::make_shared<apsis::cut_cells>(
        mesh, std::vector{of.body}, std::array{of.ends == "periodic", false, false}));
  flow.builder = std::make_unique<apsis::problem_builder>(*flow.equation);
  flow.builder->on(mesh)
      .with_discretization("finite-difference")
      .with_reconstruction(apsis::find_reconstruction(of.scheme).make())
      .with_boundary({radial, false}, side(of.inner == 0.0 ? "axis" : "diffuse", *flow.equation, of.speed))
      .with_boundary({radial, true}, side(of.outer, *flow.equation, of.speed))
      .with_axis(radial);
  if (processes) flow.builder->shared_by(processes, blocks);
  if (of.limited) flow.builder->with_positivity_limiter();
  for (const bool upper : {false, true})
    if (radial == 1) flow.builder->with_boundary({0, upper}, side(of.ends, *flow.equation, of.speed));
  if (of.body || of.box) flow.builder->with_solid(0, side("diffuse", *flow.equation));
  flow.problem = flow.builder->build();
  return flow;
}

inline double largest(const field& u) {
  double most = 0.0;
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k) most = std::max(most, std::abs(u.row(cell)[k]));
  return most;
}

inline double least(const field& u) {
  double found = std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < u.cells(); ++cell)
    found = std::min(found, *std::min_element(u.row(cell), u.row(cell) + u.components()));
  return found;
}

/// Returns nonnegative rows over many decades with exact zeros. Cells of a group have equal rows.
inline field random_state(const grid& mesh, int components, apsis::random_source& random) {
  field u(mesh.size(), components);
  for (int cell = 0; cell < u.cells(); ++cell) {
    if (mesh.solid(cell) >= 0) continue;
    const int group = mesh.cut_group(cell);
    const int first = group < 0 ? cell : mesh.cut()->groups()[at(group)].cells.front();
    for (int k = 0; k < components; ++k)
      u.row(cell)[k] = first < cell        ? u.row(first)[k]
                       : random.one_in(5)  ? 0.0
                       : random.one_in(10) ? std::pow(10.0, random.uniform(-310.0, -100.0))
                                           : std::pow(10.0, random.uniform(-12.0, 0.0));
  }
  return u;
}

/// Returns the integrals of the invariants over the gas.
inline std::vector<double> integrals(const polar_flow& flow, const field& u) {
  std::vector<double> sum(5), here(5);
  for (int cell = 0; cell < u.cells(); ++cell) {
    if (flow.mesh().solid(cell) >= 0) continue;
    flow.equation->invariant_densities(u.row(cell), here.data());
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += here[i] * flow.mesh().gas_share(cell) * flow.mesh().cell_volume();
  }
  return sum;
}

}  // namespace polar_gas_test
