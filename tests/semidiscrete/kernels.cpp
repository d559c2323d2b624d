// Kernels of transport and collision agree with the same formulas in scalar extended precision, in every
// instruction set. Fused passes give the same bits.
#include "bgk_case.hpp"

#include <apsis/core/random_source.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/model/relaxation_rows.hpp>
#include <apsis/scheme/limiter.hpp>
#include <apsis/scheme/quartic.hpp>
#include <apsis/semidiscrete/collision_rows.hpp>
#include <apsis/semidiscrete/upwind_rows.hpp>

#include <algorithm>
#include <array>
#include <span>

#include <support/instruction_sets.hpp>

namespace kernels_test {

namespace {

using apsis::field;
using apsis::grid;
using limits = apsis::limited_reconstruction::limits;
namespace limiter = apsis::limiter;

/// Returns a perturbed velocity distribution with tails below 1e-150, exact zeros and isolated spikes.
field adversarial(int cells, int components, std::uint64_t seed) {
  apsis::random_source random(seed);
  field u(cells, components);
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < components; ++k) {
      const double v = 40.0 * (k + 0.5) / components - 20.0;
      double value = (1.0 + 0.2 * std::sin(0.3 * i)) * std::exp(-v * v);
      const double kind = random.uniform(0.0, 1.0);
      if (kind < 0.15) value = 0.0;
      if (kind > 0.97) value = 10.0;
      if (kind > 0.4 && kind < 0.9) value *= random.uniform(0.0, 2.0);
      u.row(i)[k] = value;
    }
  return u;
}

/// Returns positive values with ratios of neighbours over five decades. The corrections of some cells are
/// barely harmless, those of others are not.
field steep(int cells, int components, std::uint64_t seed) {
  apsis::random_source random(seed);
  field u(cells, components);
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < components; ++k) u.row(i)[k] = std::pow(10.0, random.uniform(-2.5, 2.5));
  return u;
}

/// Scalar transport of component k. Its edges come from the scheme on a pencil of width one.
class plain_transport {
 public:
  plain_transport(const field& u, int k, std::span<const double> speeds, double spacing,
                  const apsis::limited_reconstruction& discretization)
      : discretization_(discretization) {
    n_ = u.cells();
    const double speed = speeds[static_cast<std::size_t>(k)];
    rate_ = std::abs(speed) / spacing;
    double fastest = 0.0;
    for (const double v : speeds) fastest = std::max(fastest, std::abs(v));
    inverse_cfl_ = std::min(1000.0, fastest / std::abs(speed));
    // Rows are reversed for negative velocities, so the flow is to the right below.
    for (int i = -6; i < n_ + 6; ++i) {
      const int cell = ((speed > 0.0 ? i : n_ - 1 - i) % n_ + n_) % n_;
      u_.push_back(u.row(cell)[k]);
    }
    reversed_ = speed < 0.0;
    std::vector<const double*> rows;
    for (const double& value : u_) rows.push_back(&value);
    std::vector<double> left(u_.size()), right(u_.size());
    discretization.scheme->edges(rows.data() + 2, static_cast<int>(u_.size()) - 4, 1, left.data() + 2,
                                 right.data() + 2);
    for (std::size_t i = 2; i + 2 < u_.size(); ++i) edge_.push_back(edge(u_[i], left[i], right[i]));
  }

  /// Returns −v ∂_x u in cell i by limited upwind fluxes.
  double change(int i) const {
    const int j = reversed_ ? n_ - 1 - i : i;
    return static_cast<double>(rate_ * (flux(j - 1) - flux(j)));
  }

 private:
  double value(int i) const { return u_[static_cast<std::size_t>(i + 6)]; }
  long double edge_of(int i) const { return edge_[static_cast<std::size_t>(i + 4)]; }

  long double edge(double c, double l, double r) const {
    if (!discretization_.limits_edges()) return r;
    const double theta = limiter::scaling(c, std::min({l, r, limiter::interior(c, l, r)}));
    return theta < 1.0 ? c + theta * (static_cast<long double>(r) - c) : static_cast<long double>(r);
  }

  double fraction(int i) const {
    const auto correction = [this](int j) {
      return static_cast<double>(edge_of(j) - limiter::low_order_edge(value(j)));
    };
    return limiter::limiter_coefficient(value(i - 1), value(i), correction(i - 1), correction(i),
                                        inverse_cfl_);
  }

  /// Returns the flux through the face between cells i and i + 1.
  long double flux(int i) const {
    if (!discretization_.limits_fluxes()) return edge_of(i);
    const long double low_order = limiter::low_order_edge(value(i)), correction = edge_of(i) - low_order;
    return low_order + fraction(correction > 0.0L ? i : i + 1) * correction;
  }

  apsis::limited_reconstruction discretization_;
  std::vector<double> u_;
  std::vector<long double> edge_;
  double rate_ = 0.0, inverse_cfl_ = 0.0;
  int n_ = 0;
  bool reversed_ = false;
};

void expect_plain_transport(const apsis::relaxation_model& m, const std::string& name, limits kind,
                            const field& u) {
  const int cells = u.cells();
  const grid mesh = grid::line(cells, 0.0, 1.0);
  const auto discretization = scheme(name, kind);
  const auto t = upwind(m, space_of(mesh), discretization);
  field first(cells, m.components()), second = u;
  const double dt = t.forward_euler_step();
  t.add_transport(0.0, u,
                  std::vector<apsis::target<field, double>>{{&first, 0.7, 0.6 * dt, true},
                                                            {&second, 0.25, 0.2 * dt, false}});
  for (int k = 0; k < m.components(); ++k) {
    const plain_transport plain(u, k, m.speeds(0), mesh.spacing(0), discretization);
    for (int i = 0; i < cells; ++i) {
      double size = 0.0;
      for (int j = -5; j <= 5; ++j) size = std::max(size, u.row(((i + j) % cells + cells) % cells)[k]);
      // Edges are accurate to a few 1e-16 of the largest value nearby. A step multiplies these rounding
      // errors by κ.
      const double tolerance = 4e-15 * size;
      ASSERT_NEAR(first.row(i)[k], 0.7 * u.row(i)[k] + 0.6 * dt * plain.change(i), tolerance)
          << name << " " << i << " " << k;
      ASSERT_NEAR(second.row(i)[k], 1.25 * u.row(i)[k] + 0.2 * dt * plain.change(i), tolerance);
    }
  }
}

}  // namespace

TEST(kernels, transport_agrees_with_scalar_code_in_every_instruction_set) {
  for_each_instruction_set([] {
    // There are rows of whole vectors, with a vector of mixed velocity signs in the middle, and short rows
    // that are joined.
    for (const int points : {4, 8, 20, 150})
      for (const auto kind : {limits::nothing, limits::edges, limits::fluxes}) {
        const auto m = small_bgk(points);
        const int n = m->components();
        for (const auto& [name, cells] : {std::pair{"weno5-z", 90}, {"weno5-js", 11}, {"upwind1", 30}}) {
          const auto seed = static_cast<std::uint64_t>(cells);
          expect_plain_transport(*m, name, kind, adversarial(cells, n, seed));
          expect_plain_transport(*m, name, kind, steep(cells, n, seed));
        }
      }
  });
}

TEST(kernels, gauss_values_agree_with_the_quartic_in_every_instruction_set) {
  for_each_instruction_set([] {
    for (const int width : {1, 5, 8, 152}) {
      const field u = adversarial(5, width, 7);
      std::vector<double> points(static_cast<std::size_t>(3 * width));
      for (const bool limited : {false, true}) {
        apsis::collision_rows::gauss_values({u.row(0), u.row(1), u.row(2), u.row(3), u.row(4)}, limited,
                                            width, points.data());
        for (int k = 0; k < width; ++k) {
          const double c = u.row(1)[k];
          const apsis::quartic q(u.row(0)[k], c, u.row(2)[k], u.row(3)[k], u.row(4)[k]);
          double theta = 1.0, size = 0.0;
          for (int row = 0; row < 5; ++row) size = std::max(size, u.row(row)[k]);
          if (limited) {
            double lowest =
                std::min({u.row(3)[k], u.row(4)[k], q(apsis::lobatto4_inner), q(-apsis::lobatto4_inner)});
            for (const double xi : apsis::gauss3::xi) lowest = std::min(lowest, q(xi));
            theta = limiter::scaling(c, lowest);
          }
          double mean = 0.0;
          for (std::size_t p = 0; p < 3; ++p) {
            const double value = points[p * static_cast<std::size_t>(width) + static_cast<std::size_t>(k)];
            // The sums are up to ten times as large as the largest value and have about a
            // dozen rounding errors.
            ASSERT_NEAR(value, c + theta * q.deviation(apsis::gauss3::xi[p]), 2e-14 * size) << k << " " << p;
            if (limited) {
              ASSERT_GE(value, 0.0);
            }
            mean += apsis::gauss3::weight[p] * value;
          }
          ASSERT_NEAR(mean, c, 4e-15 * size);
        }
      }
    }
  });
}

TEST(kernels, convex_combinations_agree_with_scalar_code_in_every_instruction_set) {
  for_each_instruction_set([] {
    for (const int width : {1, 3, 8, 13, 152}) {
      const field u = adversarial(6, width, 3);
      field v = u;
      apsis::relaxation::combine(0.25, 0.75, u.row(1), width, v.row(0));
      const std::array<apsis::relaxation::weighted_rows, 3> rows = {
          {apsis::relaxation::contribution(0.3, 1.0 / 3.0, 2.0 / 3.0, u.row(0), u.row(1)),
           apsis::relaxation::contribution(0.4, 0.625, 0.375, u.row(2), u.row(3)),
           apsis::relaxation::contribution(0.3, 0.0, 1.0, u.row(4), u.row(5))}};
      apsis::relaxation::mean(rows, width, v.row(1));
      for (int k = 0; k < width; ++k) {
        const auto at = [&](int row) { return static_cast<long double>(u.row(row)[k]); };
        const auto combined = static_cast<double>(0.25L * at(0) + 0.75L * at(1));
        const auto mean =
            static_cast<double>(0.1L * at(0) + 0.2L * at(1) + 0.25L * at(2) + 0.15L * at(3) + 0.3L * at(5));
        ASSERT_NEAR(v.row(0)[k], combined, 3e-16 * combined);
        ASSERT_NEAR(v.row(1)[k], mean, 1e-15 * mean);
      }
    }
  });
}

namespace {

/// Compares collisions fused with the transport that completes their points, and collisions in
/// a separate pass.
void expect_same_in_one_pass(int cells, int threads) {
  const auto m = small_bgk();
  const grid mesh = grid::line(cells, 0.0, 1.0);
  const auto make = [&] {
    std::vector<double> epsilon(static_cast<std::size_t>(cells));
    for (std::size_t i = 0; i < epsilon.size(); ++i) epsilon[i] = std::pow(10.0, -static_cast<double>(i % 8));
    return upwind_problem(*m, space_of(mesh), scheme("weno5-z", limits::fluxes),
                          apsis::make_pointwise_collision(*m, epsilon));
  };
  auto problem = make();
  field u = sample(mesh, m->components(), false, [](double x, int k) {
    return (1.5 + std::sin(6.0 * x)) * std::exp(-0.1 * (k - 20.0) * (k - 20.0));
  });
  const double dt = problem.forward_euler_step(0.0, u);
  field together(cells, m->components()), other = together, apart = together, other_apart = together;
  apsis::set_threads(threads);
  problem.add_transport_and_solve(0.0, u,
                                  std::vector<apsis::target<field, double>>{{&together, 0.9, 0.5 * dt, true},
                                                                            {&other, 0.3, 0.2 * dt, true}},
                                  {0.0, 0.4 * dt, -0.1 * dt * dt, &together});
  apsis::set_threads(1);
  problem.add_transport(0.0, u,
                        std::vector<apsis::target<field, double>>{{&apart, 0.9, 0.5 * dt, true},
                                                                  {&other_apart, 0.3, 0.2 * dt, true}});
  problem.solve_collision(0.0, 0.4 * dt, -0.1 * dt * dt, apart);
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < m->components(); ++k) {
      ASSERT_EQ(together.row(i)[k], apart.row(i)[k])
          << cells << " cells, " << threads << " threads: " << i << " " << k;
      ASSERT_EQ(other.row(i)[k], other_apart.row(i)[k]);
    }
}

}  // namespace

TEST(kernels, operations_of_a_run_include_the_limiter_of_cells_beyond_its_ends) {
  using apsis::upwind::operations;
  for (const int cells : {1, 2, 8, 64}) EXPECT_EQ(operations(false, cells), operations(false, 1)) << cells;
  const double per_cell = operations(true, 2) * 2 - operations(true, 1);
  // Fractions of 1/3 are rounded in the quotient and in the product.
  EXPECT_NEAR(operations(true, 3) * 3, operations(true, 1) + 2.0 * per_cell, 1e-13);
  // The two fluxes of a run of one cell depend on four cells, which it checks. It has one accumulation.
  EXPECT_GT(operations(true, 1), 3.0 * per_cell);
  EXPECT_LT(operations(true, 1), 4.0 * per_cell);
}

TEST(kernels, collisions_fused_with_transport_give_the_same_bits) {
  for (const int cells : {7, 64, 65, 300})
    for (const int threads : {1, 2, 3}) expect_same_in_one_pass(cells, threads);
}

}  // namespace kernels_test
