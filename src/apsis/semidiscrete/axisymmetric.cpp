#include <apsis/semidiscrete/axisymmetric.hpp>

#include <apsis/boundary/radial_boundary.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>

#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace apsis::axisymmetric {
namespace {

/// Returns f of a row of F, in memory of this thread.
std::span<const double> row_of_f(std::span<const double> u, double r) {
  thread_local std::vector<double> f;
  f.resize(u.size());
  for (std::size_t k = 0; k < u.size(); ++k) f[k] = u[k] / r;
  return f;
}

void refuse_axis(const std::vector<domain::faces>& sides) {
  for (const auto& [lower, upper] : sides)
    if (lower->is_axis() || upper->is_axis())
      throw input_error(
          "the boundary 'axis' in a flow that is not axisymmetric (it has no radius r); choose another "
          "boundary");
}

void decorate(std::shared_ptr<const boundary>& side, int radial, const grid& mesh) {
  if (side->is_axis() || side->periodic()) return;
  side = std::make_shared<radial_boundary>(std::move(side), radial, mesh.spacing(radial));
}

}  // namespace

void check(const model& equation, const grid& whole, const std::optional<int>& radial,
           const std::vector<domain::faces>& sides, const cell_unknown& unknown) {
  if (!radial) return refuse_axis(sides);
  if (equation.polar().empty())
    throw input_error(
        "the flow cannot be axisymmetric (the velocities of the model have no rings around the axis); choose "
        "polar velocities");
  if (whole.dimensions() > 2 || *radial != whole.dimensions() - 1)
    throw input_error(fmt::format(
        "axisymmetric flow in {} dimensions with r in direction {} (the mesh needs one dimension, r, or two, "
        "x and r); change the mesh",
        whole.dimensions(), *radial + 1));
  if (!unknown.pointwise())
    throw input_error(fmt::format(
        "axisymmetric flow with {} (the radius varies in a cell); use finite differences", unknown.plural()));
  const double lower = whole.edge(*radial, 0);
  if (!(lower >= 0.0))
    throw input_error(fmt::format(
        "the mesh begins at r = {:g} (the distance from the axis is not negative); let it begin at r >= 0",
        lower));
  const auto& [inner, outer] = sides[at(*radial)];
  if (inner->is_axis() != (lower == 0.0))
    throw input_error(
        lower == 0.0
            ? std::string("the lower end r = 0 is not an axis (no other boundary has an area there); choose "
                          "the boundary 'axis'")
            : fmt::format("the boundary 'axis' lies at r = {:g} (the axis is r = 0); choose another boundary",
                          lower));
  if (outer->periodic())
    throw input_error("the flow is periodic in r (its ends have different radii); choose other boundaries");
}

std::vector<domain::faces> sides_of(std::vector<domain::faces> sides, int radial, const grid& mesh) {
  for (auto& pair : sides)
    for (auto& side : pair) decorate(side, radial, mesh);
  return sides;
}

std::vector<std::shared_ptr<const boundary>> walls_of(std::vector<std::shared_ptr<const boundary>> walls,
                                                      int radial, const grid& mesh) {
  for (auto& wall : walls) decorate(wall, radial, mesh);
  return walls;
}

std::function<double(const position&)> epsilon_of(std::function<double(const position&)> epsilon,
                                                  const model& equation, int radial) {
  if (!equation.rate_is_proportional_to_density()) return epsilon;
  return [epsilon = std::move(epsilon), radial](const position& x) { return x[at(radial)] * epsilon(x); };
}

state_function data_of(const state_function& f, int radial) {
  return [f, radial](const position& x, std::span<double> u) {
    f(x, u);
    for (double& one : u) one *= x[at(radial)];
  };
}

source_rate source_of(source_rate of, int radial) {
  source_rate own{.value = {}, .steady = of.steady};
  own.value = [value = std::move(of.value), radial](double t, const position& x, std::span<const double> u,
                                                    std::span<double> row) {
    const double r = x[at(radial)];
    value(t, x, row_of_f(u, r), row);
    for (double& one : row) one *= r;
  };
  if (of.growth)
    own.growth = [growth = std::move(of.growth), radial](double t, const position& x,
                                                         std::span<const double> u) {
      return growth(t, x, row_of_f(u, x[at(radial)]));
    };
  return own;
}

}  // namespace apsis::axisymmetric
