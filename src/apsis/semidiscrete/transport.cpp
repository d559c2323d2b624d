#include <apsis/semidiscrete/transport.hpp>

#include <apsis/core/parallel.hpp>
#include <apsis/space/limiter.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
  return safe * (how_.positivity != limiter_kind::none ? limiter::end_weight : 1.0) / rate;
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

/// T along one direction for the cells of one block, cell by cell.
class transport::block_sweep {
 public:
  void attach(const stencil& how, const line_speeds& line) {
    how_ = &how;
    line_ = &line;
  }

  /// Edge values of cells begin … end−1 and of the neighbours that their fluxes need.
  void load(const field& u, const grid& mesh, int direction, int pencil, int begin, int end) {
    width_ = u.stride();
    const bool fluxes = how_->positivity == limiter_kind::fluxes;
    block_.load(u, mesh, *how_, direction, pencil, begin, end, fluxes ? 2 : 1);
    change_.resize(static_cast<std::size_t>(width_));
    if (how_->positivity == limiter_kind::edges)
      for (int i = begin - 1; i <= end; ++i)
        limiter::apply(block_.row(i), width_, block_.left_edge(i), block_.right_edge(i));
    if (!fluxes) return;
    first_fraction_ = begin - 1;
    fractions_.resize(static_cast<std::size_t>(end - begin + 2) * static_cast<std::size_t>(width_));
    for (int i = begin - 1; i <= end; ++i) find_fractions(i);
  }

  const double* row(int i) const { return block_.row(i); }

  /// |v|/Δx (inflow − outflow) of cell i.
  double* change(int i) {
    if (how_->positivity == limiter_kind::fluxes) {
      limited_change(i);
    } else {
      plain_change(i);
    }
    return change_.data();
  }

  void add_source(const model& equation, int i) {
    source_.assign(static_cast<std::size_t>(width_), 0.0);
    equation.source(row(i), source_.data());
    for (std::size_t k = 0; k < source_.size(); ++k) change_[k] += source_[k];
  }

 private:
  double* fraction(int i) {
    return fractions_.data() +
           static_cast<std::size_t>(i - first_fraction_) * static_cast<std::size_t>(width_);
  }

  /// Cell i and its neighbours seen in the direction of motion of every component.
  struct motion {
    const double *before, *here, *after, *from_left, *left, *right, *from_right, *forward;

    bool ahead(int k) const { return forward[k] > 0.5; }
    double upstream(int k) const { return ahead(k) ? before[k] : after[k]; }
    double inflow(int k) const { return ahead(k) ? from_left[k] : from_right[k]; }
    double outflow(int k) const { return ahead(k) ? right[k] : left[k]; }
  };

  motion around(int i) {
    return {row(i - 1),
            row(i),
            row(i + 1),
            block_.right_edge(i - 1),
            block_.left_edge(i),
            block_.right_edge(i),
            block_.left_edge(i + 1),
            line_->forward.data()};
  }

  void plain_change(int i) {
    const motion cell = around(i);
    const double* per_cell = line_->per_cell.data();
    double* t = change_.data();
#pragma omp simd
    for (int k = 0; k < width_; ++k) t[k] = per_cell[k] * (cell.inflow(k) - cell.outflow(k));
  }

  void find_fractions(int i) {
    const motion cell = around(i);
    double* r = fraction(i);
#pragma omp simd
    for (int k = 0; k < width_; ++k)
      r[k] = limiter::harmless_fraction(cell.upstream(k), cell.here[k], cell.inflow(k) - cell.upstream(k),
                                        cell.outflow(k) - cell.here[k]);
  }

  void limited_change(int i) {
    const motion cell = around(i);
    const double *r_before = fraction(i - 1), *r_here = fraction(i), *r_after = fraction(i + 1);
    const double* per_cell = line_->per_cell.data();
    double* t = change_.data();
#pragma omp simd
    for (int k = 0; k < width_; ++k) {
      const double r_up = cell.ahead(k) ? r_before[k] : r_after[k];
      const double r_down = cell.ahead(k) ? r_after[k] : r_before[k];
      const double u_up = cell.upstream(k), u = cell.here[k];
      const double a_in = cell.inflow(k) - u_up, a_out = cell.outflow(k) - u;
      // A positive correction harms the donor, a negative one the receiver.
      const double in = u_up + (a_in > 0.0 ? r_up : r_here[k]) * a_in;
      const double out = u + (a_out > 0.0 ? r_here[k] : r_down) * a_out;
      t[k] = per_cell[k] * (in - out);
    }
  }

  const stencil* how_ = nullptr;
  const line_speeds* line_ = nullptr;
  pencil_block block_;
  aligned_vector<double> change_, fractions_, source_;
  int width_ = 0, first_fraction_ = 0;
};

void transport::scatter_direction(const field& u, targets_view targets, int direction) const {
  const int n = mesh_.cells(direction);
  const int length = block_length(u.stride());
  const int blocks = (n + length - 1) / length;
  const auto& line = speeds_[static_cast<std::size_t>(direction)];
  const bool first = direction == 0;

  parallel_for(mesh_.pencils(direction) * blocks, [&](int task) {
    thread_local block_sweep sweep;
    sweep.attach(how_, line);
    const int pencil = task / blocks;
    const int begin = task % blocks * length, end = std::min(n, begin + length);
    sweep.load(u, mesh_, direction, pencil, begin, end);
    for (int i = begin; i < end; ++i) {
      double* t = sweep.change(i);
      if (first && equation_.has_source()) sweep.add_source(equation_, i);
      const int cell = mesh_.first_cell(direction, pencil) + i * mesh_.stride(direction);
      for (const auto& to : targets) accumulate(to, cell, sweep.row(i), t, u.stride(), first);
    }
  });
}

}  // namespace apsis
