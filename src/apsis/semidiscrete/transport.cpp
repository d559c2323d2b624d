#include <apsis/semidiscrete/transport.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <apsis/core/parallel.hpp>
#include <apsis/space/limiter.hpp>

namespace apsis {
namespace {

using targets_view = std::span<const target<field, double>>;

/// acc ← (fresh ? 0 : acc) + α u + β T for one row.
void accumulate(const target<field, double>& to, int cell, const double* u, const double* t, int width,
                bool first) {
  double* acc = to.acc->row(cell);
  const double alpha = first ? to.alpha : 0.0, beta = to.beta;
  if (first && to.fresh) {
#pragma omp simd
    for (int k = 0; k < width; ++k) acc[k] = alpha * u[k] + beta * t[k];
  } else {
#pragma omp simd
    for (int k = 0; k < width; ++k) acc[k] += alpha * u[k] + beta * t[k];
  }
}

}  // namespace

transport::transport(const model& equation, const grid& mesh, stencil how)
    : equation_(equation), mesh_(mesh), how_(std::move(how)) {
  if (equation.space_dimensions() == 0) return;
  const field layout(1, equation.components());
  for (int direction = 0; direction < mesh.dimensions(); ++direction) {
    line_speeds line;
    line.per_cell.assign(static_cast<std::size_t>(layout.stride()), 0.0);
    line.forward.assign(static_cast<std::size_t>(layout.stride()), 0.0);
    const auto v = equation.speeds(direction);
    for (std::size_t k = 0; k < v.size(); ++k) {
      line.per_cell[k] = std::abs(v[k]) / mesh.spacing(direction);
      line.forward[k] = v[k] > 0.0 ? 1.0 : 0.0;
    }
    speeds_.push_back(std::move(line));
  }
}

double transport::forward_euler_step() const {
  double rate = 0.0;  // 1/0 is the infinity of a model without space
  for (const auto& line : speeds_) rate += *std::max_element(line.per_cell.begin(), line.per_cell.end());
  // The rounding of α u + β T(u), a few units in the last place, must not cross what is exact at the limit.
  constexpr double safe = 1.0 - 1e-14;
  return safe * (how_.positivity_limiter ? limiter::end_weight : 1.0) / rate;
}

void transport::scatter(const field& u, targets_view targets) const {
  const bool moves =
      std::any_of(targets.begin(), targets.end(), [](const auto& to) { return to.beta != 0.0; });
  if (!moves) return scatter_weights(u, targets);
  if (equation_.space_dimensions() == 0) return scatter_source(u, targets);
  for (int direction = 0; direction < mesh_.dimensions(); ++direction)
    scatter_direction(u, targets, direction);
}

void transport::scatter_source(const field& u, targets_view targets) const {
  std::vector<double> t(static_cast<std::size_t>(u.stride()), 0.0);
  for (int cell = 0; cell < u.cells(); ++cell) {
    if (equation_.has_source()) equation_.source(u.row(cell), t.data());
    for (const auto& to : targets) accumulate(to, cell, u.row(cell), t.data(), u.stride(), true);
  }
}

void transport::scatter_weights(const field& u, targets_view targets) const {
  const int width = u.stride();
  const int length = block_length(width);
  const int blocks = (u.cells() + length - 1) / length;
  parallel_for(blocks, [&](int block) {
    const int end = std::min(u.cells(), (block + 1) * length);
    for (int cell = block * length; cell < end; ++cell) {
      const double* row = u.row(cell);
      for (const auto& to : targets) {
        double* acc = to.acc->row(cell);
        const double alpha = to.alpha;
        if (to.fresh) {
#pragma omp simd
          for (int k = 0; k < width; ++k) acc[k] = alpha * row[k];
        } else {
#pragma omp simd
          for (int k = 0; k < width; ++k) acc[k] += alpha * row[k];
        }
      }
    }
  });
}

void transport::scatter_direction(const field& u, targets_view targets, int direction) const {
  const int width = u.stride();
  const int n = mesh_.cells(direction);
  const int length = block_length(width);
  const int blocks = (n + length - 1) / length;
  const auto& line = speeds_[static_cast<std::size_t>(direction)];
  const double* per_cell = line.per_cell.data();
  const double* forward = line.forward.data();

  parallel_for(mesh_.pencils(direction) * blocks, [&](int task) {
    thread_local pencil_block block;
    thread_local aligned_vector<double> change, source;
    const int pencil = task / blocks;
    const int begin = task % blocks * length, end = std::min(n, begin + length);
    block.load(u, mesh_, how_, direction, pencil, begin, end, 1);
    if (how_.positivity_limiter)
      for (int i = begin - 1; i <= end; ++i)
        limiter::apply(block.row(i), width, block.left_edge(i), block.right_edge(i));
    change.resize(static_cast<std::size_t>(width));
    source.assign(static_cast<std::size_t>(width), 0.0);
    double* t = change.data();
    for (int i = begin; i < end; ++i) {
      const double* from_left = block.right_edge(i - 1);
      const double* from_right = block.left_edge(i + 1);
      const double* left = block.left_edge(i);
      const double* right = block.right_edge(i);
#pragma omp simd
      for (int k = 0; k < width; ++k) {
        const bool ahead = forward[k] > 0.5;
        const double in = ahead ? from_left[k] : from_right[k];
        const double out = ahead ? right[k] : left[k];
        t[k] = per_cell[k] * (in - out);
      }
      if (direction == 0 && equation_.has_source()) {
        equation_.source(block.row(i), source.data());
        for (int k = 0; k < width; ++k) t[k] += source[static_cast<std::size_t>(k)];
      }
      const int cell = mesh_.first_cell(direction, pencil) + i * mesh_.stride(direction);
      for (const auto& to : targets) accumulate(to, cell, block.row(i), t, width, direction == 0);
    }
  });
}

}  // namespace apsis
