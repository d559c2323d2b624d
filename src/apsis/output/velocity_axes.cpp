#include <apsis/output/velocity_axes.hpp>

#include <apsis/velocity/component_name.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

namespace apsis {
namespace {

std::vector<double> distinct(const double* values, std::size_t count) {
  std::vector<double> found(values, values + count);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Returns the distance between the outermost nodes plus half an interval at each end; 1 for a single node.
double width(const std::vector<double>& nodes) {
  const std::size_t n = nodes.size();
  if (n < 2) return 1.0;
  return std::abs(nodes[n - 1] - nodes[0]) +
         0.5 * (std::abs(nodes[1] - nodes[0]) + std::abs(nodes[n - 1] - nodes[n - 2]));
}

/// Returns the distance in the set between neighbours along axis k.
std::size_t stride_of(const std::vector<velocity_axis>& axes, std::size_t k) {
  std::size_t stride = 1;
  for (std::size_t l = k + 1; l < axes.size(); ++l) stride *= axes[l].nodes.size();
  return stride;
}

/// Returns whether the n coordinates repeat the nodes in the order of a tensor product.
bool repeats(const std::vector<double>& nodes, std::size_t stride, const double* coordinates, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j)
    if (coordinates[j] != nodes[j / stride % nodes.size()]) return false;
  return true;
}

/// Sets the weights of the nodes to sums over all velocities with the same v_k. Their sum is
/// the width of the axis.
void set_weights(std::span<const double> of_points, double total, std::vector<velocity_axis>& axes) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    auto& axis = axes[k];
    const std::size_t stride = stride_of(axes, k), n = axis.nodes.size();
    axis.weights.assign(n, 0.0);
    for (std::size_t j = 0; j < of_points.size(); ++j) axis.weights[j / stride % n] += of_points[j];
    for (double& w : axis.weights) w *= width(axis.nodes) / total;
  }
}

/// Returns whether the weights of the velocities are products of those of the nodes, up to
/// rounding and a factor.
bool weights_are_products(std::span<const double> of_points, double total,
                          const std::vector<velocity_axis>& axes) {
  constexpr double rounding = 1e-12;
  double widths = 1.0;
  for (const auto& axis : axes) widths *= width(axis.nodes);
  for (std::size_t j = 0; j < of_points.size(); ++j) {
    double product = total / widths;
    for (std::size_t k = 0; k < axes.size(); ++k)
      product *= axes[k].weights[j / stride_of(axes, k) % axes[k].nodes.size()];
    if (!(std::abs(of_points[j] - product) <= rounding * product)) return false;
  }
  return true;
}

}  // namespace

std::vector<velocity_axis> velocity_axes(const velocity_set& velocities) {
  const auto n = static_cast<std::size_t>(velocities.size());
  const int d = velocities.dimensions();
  std::vector<velocity_axis> axes(static_cast<std::size_t>(d));
  std::size_t points = 1;
  for (int k = 0; k < d; ++k) {
    auto& axis = axes[static_cast<std::size_t>(k)];
    axis.name = component_name("v", k, d);
    axis.nodes = distinct(velocities.speeds(k).data(), n);
    points *= axis.nodes.size();
    if (points > n) return {};
  }
  if (n == 0 || points != n) return {};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const double* coordinates = velocities.speeds(static_cast<int>(k)).data();
    if (coordinates[0] != axes[k].nodes.front()) std::reverse(axes[k].nodes.begin(), axes[k].nodes.end());
    if (!repeats(axes[k].nodes, stride_of(axes, k), coordinates, n)) return {};
  }
  const auto weights = velocities.weights();
  if (d == 1) {
    axes[0].weights.assign(weights.begin(), weights.end());
    return axes;
  }
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  set_weights(weights, total, axes);
  return weights_are_products(weights, total, axes) ? axes : std::vector<velocity_axis>();
}

std::vector<double> velocity_points(const velocity_set& velocities) {
  std::vector<double> points;
  for (int j = 0; j < velocities.size(); ++j)
    for (int k = 0; k < velocities.dimensions(); ++k)
      points.push_back(velocities.speeds(k)[static_cast<std::size_t>(j)]);
  return points;
}

namespace {

/// values[i] ← Σ w_j f_j over the velocities with node i of an axis, divided by the weight of the node.
void integrate_row(const double* f, std::span<const double> weights, std::size_t stride,
                   const velocity_axis& axis, double* values) {
  const std::size_t n = axis.nodes.size();
  for (std::size_t j = 0; j < weights.size();)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t s = 0; s < stride; ++s, ++j) values[i] += weights[j] * f[j];
  for (std::size_t i = 0; i < n; ++i)
    if (axis.weights[i] > 0.0) values[i] /= axis.weights[i];
}

std::string names_without(const std::vector<velocity_axis>& axes, std::size_t k) {
  std::string names;
  for (std::size_t l = 0; l < axes.size(); ++l)
    if (l != k) names += (names.empty() ? "" : " and ") + axes[l].name;
  return names;
}

}  // namespace

std::vector<marginal_distribution> marginals(const std::vector<double>& f, std::uint64_t cells,
                                             const velocity_set& velocities) {
  std::vector<marginal_distribution> all;
  if (velocities.dimensions() < 2 || velocities.sets() > 1) return all;
  const auto axes = velocity_axes(velocities);
  const auto weights = velocities.weights();
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const std::size_t n = axes[k].nodes.size(), stride = stride_of(axes, k);
    marginal_distribution one{axes[k], "f integrated over " + names_without(axes, k),
                              std::vector<double>(cells * n)};
    for (std::size_t cell = 0; cell < cells; ++cell)
      integrate_row(f.data() + cell * weights.size(), weights, stride, axes[k], one.values.data() + cell * n);
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace apsis
