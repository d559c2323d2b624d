#include <apsis/core/parallel.hpp>
#include <apsis/semidiscrete/collision.hpp>
#include <apsis/semidiscrete/local_relaxation.hpp>
#include <apsis/space/limiter.hpp>
#include <apsis/space/quartic.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace apsis {
namespace {

/// Values of the quartics of one cell at its three Gauss points, one row each.
struct gauss_rows {
  std::array<aligned_vector<double>, gauss3::points> rows;
  aligned_vector<double> sum;

  void resize(int width) {
    for (auto& row : rows) row.resize(static_cast<std::size_t>(width));
    sum.resize(static_cast<std::size_t>(width));
  }
};

/// θ that brings the quartic to nonnegative values at its Gauss–Lobatto and Gauss–Legendre points.
double positive_scaling(const quartic& q, double edges, double g0, double g1, double g2) {
  const double inner = std::min(q.deviation(-lobatto4_inner), q.deviation(lobatto4_inner));
  const double lowest = std::min(std::min(edges, inner), std::min(std::min(g0, g1), g2));
  return limiter::scaling(q.c, q.c + lowest);
}

template <bool Limited>
void gauss_values(const double* m, const double* c, const double* p, const double* l, const double* r,
                  int width, gauss_rows& out) {
  double* g0 = out.rows[0].data();
  double* g1 = out.rows[1].data();
  double* g2 = out.rows[2].data();
#pragma omp simd
  for (int k = 0; k < width; ++k) {
    const quartic q(m[k], c[k], p[k], l[k], r[k]);
    const double v0 = q.deviation(gauss3::xi[0]), v1 = q.deviation(gauss3::xi[1]),
                 v2 = q.deviation(gauss3::xi[2]);
    const double theta = Limited ? positive_scaling(q, std::min(l[k], r[k]) - c[k], v0, v1, v2) : 1.0;
    g0[k] = c[k] + theta * v0;
    g1[k] = c[k] + theta * v1;
    g2[k] = c[k] + theta * v2;
  }
}

class cell_average_collision final : public collision {
 public:
  cell_average_collision(const relaxation_model& equation, const grid& mesh, stencil how,
                         std::vector<double> epsilon)
      : equation_(equation), mesh_(mesh), how_(std::move(how)), epsilon_(std::move(epsilon)) {}

  void solve(double a, double b, field& u) override {
    if (result_.cells() != u.cells() || result_.components() != u.components())
      result_ = field(u.cells(), u.components());
    for_cells(u, [&](int cell, const gauss_rows& points, local_relaxation& local, double* sum) {
      for (std::size_t q = 0; q < gauss3::points; ++q) {
        const double* row = points.rows[q].data();
        const auto weights = local.prepare(row, a, b, epsilon_at(cell, q), cell);
        const double* e = local.equilibrium();
        const double stay = weights.stay, relax = weights.relax, weight = gauss3::weight[q];
#pragma omp simd
        for (int k = 0; k < u.components(); ++k) sum[k] += weight * (stay * row[k] + relax * e[k]);
      }
      std::copy_n(sum, u.components(), result_.row(cell));
    });
    std::swap(u, result_);  // neighbours need the old averages, so the new ones are made beside them
  }

  void scatter(const field& u, std::span<const target<field, double>> targets) override {
    for_cells(u, [&](int cell, const gauss_rows& points, local_relaxation& local, double* sum) {
      for (std::size_t q = 0; q < gauss3::points; ++q) {
        const double* row = points.rows[q].data();
        const double strength = gauss3::weight[q] * local.strength(row, epsilon_at(cell, q), cell);
        const double* e = local.equilibrium();
#pragma omp simd
        for (int k = 0; k < u.components(); ++k) sum[k] += strength * (e[k] - row[k]);
      }
      for (const auto& to : targets) {
        double* acc = to.acc->row(cell);
        const double* average = u.row(cell);
        for (int k = 0; k < u.components(); ++k) acc[k] = to.combine(acc[k], average[k], sum[k]);
      }
    });
  }

  /// With the rate of the averages; the rates at the Gauss points differ by the accuracy of the scheme.
  double forward_euler_step(const field& u) const override {
    local_relaxation local;
    local.attach(equation_);
    double fastest = 0.0;
    for (int cell = 0; cell < u.cells(); ++cell)
      for (std::size_t q = 0; q < gauss3::points; ++q)
        fastest = std::max(fastest, local.rate(u.row(cell)) / epsilon_at(cell, q));
    return 1.0 / fastest;
  }

  double relaxation_time(const field& u) const override {
    local_relaxation local;
    local.attach(equation_);
    double shortest = std::numeric_limits<double>::infinity();
    for (int cell = 0; cell < u.cells(); ++cell)
      for (std::size_t q = 0; q < gauss3::points; ++q)
        shortest = std::min(shortest, local.relaxation_time(u.row(cell), epsilon_at(cell, q)));
    return shortest;
  }

 private:
  double epsilon_at(int cell, std::size_t q) const {
    return epsilon_[static_cast<std::size_t>(cell) * gauss3::points + q];
  }

  /// body(cell, Gauss values, scratch, row of zeros) for every cell.
  template <class Body>
  void for_cells(const field& u, Body body) {
    const int length = block_length(u.stride());
    parallel_for((u.cells() + length - 1) / length, [&](int task) {
      thread_local pencil_block block;
      thread_local gauss_rows points;
      thread_local local_relaxation local;
      local.attach(equation_);
      points.resize(u.stride());
      const int begin = task * length, end = std::min(u.cells(), begin + length);
      block.load(u, mesh_, how_, 0, 0, begin, end, 0);
      for (int i = begin; i < end; ++i) {
        const auto values = how_.positivity != limiter_kind::none ? gauss_values<true> : gauss_values<false>;
        values(block.row(i - 1), block.row(i), block.row(i + 1), block.left_edge(i), block.right_edge(i),
               u.stride(), points);
        std::fill(points.sum.begin(), points.sum.end(), 0.0);
        body(i, points, local, points.sum.data());
      }
    });
  }

  const relaxation_model& equation_;
  const grid& mesh_;
  stencil how_;
  std::vector<double> epsilon_;
  field result_;
};

}  // namespace

std::unique_ptr<collision> make_cell_average_collision(const relaxation_model& equation, const grid& mesh,
                                                       stencil how, std::vector<double> epsilon) {
  if (mesh.dimensions() != 1)
    throw input_error(
        "the finite volume formulation collides at the Gauss points of intervals and knows one space "
        "dimension only; use the finite difference formulation");
  return std::make_unique<cell_average_collision>(equation, mesh, std::move(how), std::move(epsilon));
}

}  // namespace apsis
