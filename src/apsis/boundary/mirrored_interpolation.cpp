#include <apsis/boundary/mirrored_interpolation.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace apsis {
namespace {

/// The corners of the cell around a velocity with their weights.
template <std::size_t D>
struct cell_corners {
  static constexpr std::size_t count = std::size_t{1} << D;
  std::array<std::size_t, count> component{};
  std::array<double, count> weight{};

  cell_corners(const tensor_axes& axes, const std::array<double, D>& v) {
    weight[0] = 1.0;
    for (std::size_t k = 0, made = 1; k < D; ++k, made *= 2) {
      const auto [below, share] = axes.find(k, v[k]);
      const std::size_t stride = axes.stride(k), lower = below * stride;
      for (std::size_t c = 0; c < made; ++c) {
        component[c] += lower;
        component[c + made] = component[c] + stride;
        weight[c + made] = weight[c] * share;
        weight[c] *= 1.0 - share;
      }
    }
  }
};

/// Calls act(j, v'_j) for all velocities with the given sign of v·n.
template <std::size_t D, class Act>
void for_mirrored(const tensor_axes& axes, const std::array<double, 3>& normal, const double* inward,
                  double sign, const Act& act) {
  const std::vector<double>& last = axes.last();
  for (std::size_t line = 0; line < axes.lines(); ++line) {
    const auto indices = axes.indices_of_line(line);
    std::array<double, D> v{};
    for (std::size_t k = 0; k + 1 < D; ++k) v[k] = axes.points(k)[indices[k]];
    for (std::size_t i = 0; i < last.size(); ++i) {
      const std::size_t j = line * last.size() + i;
      if (!(sign * inward[j] > 0.0)) continue;
      v[D - 1] = last[i];
      std::array<double, D> mirrored{};
      double shorter = 1.0;
      for (std::size_t k = 0; k < D; ++k) {
        mirrored[k] = v[k] - 2.0 * inward[j] * normal[k];
        const double end = mirrored[k] > 0.0 ? axes.points(k).back() : axes.points(k).front();
        // On an axis without 0, this end may have the opposite sign.
        if (std::abs(mirrored[k]) > std::abs(end) && end * mirrored[k] > 0.0)
          shorter = std::min(shorter, end / mirrored[k]);
      }
      for (double& one : mirrored) one *= shorter;
      act(j, mirrored);
    }
  }
}

/// Returns a depth such that v·n < −depth implies v·n < 0 at all corners of the cell around v.
double depth_of_cells(const tensor_axes& axes, const std::array<double, 3>& normal) {
  double depth = 0.0;
  for (std::size_t k = 0; k < axes.dimensions(); ++k) {
    const std::vector<double>& v = axes.points(k);
    double widest = 0.0;
    for (std::size_t i = 1; i < v.size(); ++i) widest = std::max(widest, v[i] - v[i - 1]);
    depth += std::abs(normal[k]) * widest;
  }
  return depth;
}

template <std::size_t D>
void gather_in(const tensor_axes& axes, const std::array<double, 3>& normal, const double* inward,
               std::size_t sets, const double* from, double* values) {
  const std::size_t n = axes.size();
  const double depth = depth_of_cells(axes, normal);
  for_mirrored<D>(axes, normal, inward, 1.0, [&](std::size_t j, const std::array<double, D>& v) {
    const cell_corners<D> around(axes, v);
    double share = 1.0, along = 0.0;
    for (std::size_t k = 0; k < D; ++k) along += normal[k] * v[k];
    if (!(along < -depth)) {
      double all = 0.0;
      for (std::size_t c = 0; c < around.count; ++c)
        all += inward[around.component[c]] < 0.0 ? around.weight[c] : 0.0;
      share = all > 0.0 ? 1.0 / all : 0.0;
    }
    for (std::size_t s = 0; s < sets; ++s) {
      const double* row = from + s * n;
      double sum = 0.0;
      for (std::size_t c = 0; c < around.count; ++c) sum += around.weight[c] * row[around.component[c]];
      values[s * n + j] = sum * share;
    }
  });
}

template <std::size_t D>
void deposit_in(const tensor_axes& axes, const std::array<double, 3>& normal, const double* inward,
                const double* weights, const double* arriving, double* values) {
  const auto flux = [&](std::size_t j) { return weights[j] * inward[j]; };
  std::size_t fastest = 0;
  for (std::size_t j = 0; j < axes.size(); ++j) {
    if (inward[j] > 0.0) values[j] = 0.0;
    if (flux(j) > flux(fastest)) fastest = j;
  }
  if (!(flux(fastest) > 0.0)) return;
  for_mirrored<D>(axes, normal, inward, -1.0, [&](std::size_t p, const std::array<double, D>& v) {
    const cell_corners<D> around(axes, v);
    std::size_t nearest = fastest;
    double most = 0.0;
    for (std::size_t c = 0; c < around.count; ++c)
      if (flux(around.component[c]) > 0.0 && around.weight[c] > most) {
        most = around.weight[c];
        nearest = around.component[c];
      }
    values[nearest] -= flux(p) * arriving[p] / flux(nearest);
  });
}

}  // namespace

void mirrored_interpolation::gather(const tensor_axes& axes, const std::array<double, 3>& normal,
                                    const double* inward, std::size_t sets, const double* from,
                                    double* values) {
  switch (axes.dimensions()) {
    case 1:
      return gather_in<1>(axes, normal, inward, sets, from, values);
    case 2:
      return gather_in<2>(axes, normal, inward, sets, from, values);
    default:
      return gather_in<3>(axes, normal, inward, sets, from, values);
  }
}

void mirrored_interpolation::deposit(const tensor_axes& axes, const std::array<double, 3>& normal,
                                     const double* inward, const double* weights, const double* arriving,
                                     double* values) {
  switch (axes.dimensions()) {
    case 1:
      return deposit_in<1>(axes, normal, inward, weights, arriving, values);
    case 2:
      return deposit_in<2>(axes, normal, inward, weights, arriving, values);
    default:
      return deposit_in<3>(axes, normal, inward, weights, arriving, values);
  }
}

}  // namespace apsis
