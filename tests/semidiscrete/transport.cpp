#include "bgk_case.hpp"

#include <apsis/exec/parallel.hpp>

#include <algorithm>
#include <limits>

#include <support/property.hpp>

namespace transport_test {

namespace {

using apsis::field;
using apsis::grid;
using limits = apsis::limited_reconstruction::limits;

/// Share of the longest step for which limited fluxes keep fifth order where the solution touches zero.
constexpr double short_step = 1.0 / 12.0;

/// Returns the L1 error of T(u) for u = 1 + sin(2πx), which touches zero. The limiter is that for steps of a
/// share of Δt_FE.
double transport_error(const apsis::relaxation_model& m, const std::string& name, limits kind, bool averages,
                       int n, double share = short_step) {
  const grid mesh = grid::line(n, 0.0, 1.0);
  auto t = upwind(m, space_of(mesh), scheme(name, kind));
  t.limit_for_steps(share);
  const double w = 2.0 * std::numbers::pi;
  const field u =
      sample(mesh, m.components(), averages, [w](double x, int) { return 1.0 + std::sin(w * x); });
  const field exact = sample(mesh, m.components(), averages, [&](double x, int k) {
    return -m.speeds(0)[static_cast<std::size_t>(k)] * w * std::cos(w * x);
  });
  const field numerical = transport_of(t, u);
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < m.components(); ++k) sum += std::abs(numerical.row(i)[k] - exact.row(i)[k]);
  return sum / (n * m.components());
}

}  // namespace

TEST(transport, fifth_order_in_both_formulations_with_and_without_limiter) {
  const auto m = small_bgk(8);
  for (const char* name : {"weno5-z", "weno5-js", "teno5"}) {
    for (const bool limited : {false, true}) {
      for (const bool averages : {true, false}) {
        const limits cut = averages ? limits::edges : limits::fluxes;
        const limits kind = limited ? cut : limits::nothing;
        const double slope = std::log2(transport_error(*m, name, kind, averages, 80) /
                                       transport_error(*m, name, kind, averages, 160));
        EXPECT_GT(slope, 4.8) << name << " limited " << limited << " averages " << averages;
      }
    }
  }
}

TEST(transport, limiting_edges_of_point_values_costs_three_orders_and_limiting_fluxes_none) {
  // Near the minimum the flux function of 1 + sin(2πx) is negative; see limiter.hpp.
  const auto m = small_bgk(8);
  const auto slope = [&m](limits kind) {
    const auto error = [&](int n) { return transport_error(*m, "weno5-z", kind, false, n); };
    return std::log2(error(80) / error(160));
  };
  EXPECT_LT(slope(limits::edges), 2.5);
  EXPECT_GT(slope(limits::fluxes), 4.8);
}

TEST(transport, limited_fluxes_change_less_for_shorter_steps_and_slower_velocities) {
  // Where the solution touches zero the longest step loses accuracy, because an exact forward Euler step is
  // negative there. A step 1000 times shorter, for which κ is smallest, loses none.
  const auto m = small_bgk(8);
  const auto error = [&](limits kind, double share) {
    return transport_error(*m, "weno5-z", kind, false, 80, share);
  };
  const double without = error(limits::nothing, 1.0);
  double longer = error(limits::fluxes, 1.0);
  EXPECT_GT(longer, 3.0 * without);
  EXPECT_LT(error(limits::fluxes, 0.5), 0.7 * longer);
  for (const double share : {0.5, 0.25, 0.1}) {
    const double shorter = error(limits::fluxes, share);
    EXPECT_LE(shorter, longer) << share;
    longer = shorter;
  }
  EXPECT_DOUBLE_EQ(error(limits::fluxes, 1e-3), without);
  // The slowest velocity needs seven times as long as the fastest to leave a cell.
  const grid mesh = grid::line(80, 0.0, 1.0);
  const field u =
      sample(mesh, 8, false, [](double x, int) { return 1.0 + std::sin(2.0 * std::numbers::pi * x); });
  const auto limited = upwind(*m, space_of(mesh), scheme("weno5-z", limits::fluxes));
  const auto free = upwind(*m, space_of(mesh), scheme("weno5-z", limits::nothing));
  const field a = transport_of(limited, u), b = transport_of(free, u);
  std::vector<double> change(8, 0.0);
  for (int i = 0; i < 80; ++i)
    for (int k = 0; k < 8; ++k)
      change[static_cast<std::size_t>(k)] +=
          std::abs(a.row(i)[k] - b.row(i)[k]) / std::abs(m->speeds(0)[static_cast<std::size_t>(k)]);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(change[k], 1.5 * change[k + 1]) << k;
}

TEST(transport, first_order_upwind_is_the_difference_of_neighbours) {
  const auto m = small_bgk(6);
  const grid mesh = grid::line(9, 0.0, 1.8);
  const auto t = upwind(*m, space_of(mesh), scheme("upwind1", limits::nothing));
  const field u = sample(mesh, 6, false, [](double x, int k) { return 1.0 + x * x + k; });
  const field change = transport_of(t, u);
  for (int i = 0; i < 9; ++i) {
    for (int k = 0; k < 6; ++k) {
      const double v = m->speeds(0)[static_cast<std::size_t>(k)];
      const int upwind = v > 0 ? (i + 8) % 9 : (i + 1) % 9;
      const double expected = -std::abs(v) * (u.row(i)[k] - u.row(upwind)[k]) / 0.2;
      EXPECT_NEAR(change.row(i)[k], expected, 1e-12);
    }
  }
}

TEST(transport, a_step_of_dt_fe_keeps_any_data_nonnegative_in_floating_point) {
  const auto m = small_bgk(8);
  const grid mesh = grid::line(12, 0.0, 1.0);
  for (const auto kind : {limits::edges, limits::fluxes, limits::nothing}) {
    const std::string name = kind == limits::nothing ? "upwind1" : "weno5-z";
    auto t = upwind(*m, space_of(mesh), scheme(name, kind));
    check_property(name + " limiter " + std::to_string(static_cast<int>(kind)), [&] {
      const field u = random_rows(mesh, 8);
      const double share = *rc::gen::element(1.0, 0.999, 0.3, 1e-2, 1e-5);
      t.limit_for_steps(share);
      const double dt = share * t.forward_euler_step();
      // A stage has a weight w ≤ 1 and the step w Δt.
      const double w = *rc::gen::inRange(1, 1001) * 1e-3;
      field result(mesh.size(), 8);
      const apsis::target<field, double> to{&result, w, w * dt, true};
      t.add_transport(0.0, u, {&to, 1});
      RC_ASSERT(smallest(result) >= 0.0);
    });
  }
}

TEST(transport, above_dt_fe_positivity_breaks) {
  // Nothing flows into the first of two nonzero cells. At Δt_FE the fastest molecules have just left it. Its
  // edge is above its value, so the limiter lets out as much as it allows.
  const auto m = small_bgk(8);
  const grid mesh = grid::line(12, 0.0, 1.0);
  field u(12, 8);
  for (int k = 0; k < 8; ++k) {
    u.row(5)[k] = 1.0;
    u.row(6)[k] = 5.0;
  }
  for (const auto& [name, kind] : {std::pair{"upwind1", limits::nothing}, {"weno5-z", limits::fluxes}})
    for (const double steps : {1.0, 1.001}) {
      auto t = upwind(*m, space_of(mesh), scheme(name, kind));
      field result(12, 8);
      const apsis::target<field, double> to{&result, 1.0, steps * t.forward_euler_step(), true};
      t.add_transport(0.0, u, {&to, 1});
      EXPECT_EQ(smallest(result) >= 0.0, steps == 1.0) << name << " " << steps;
    }
}

TEST(transport, conserves_every_component) {
  const auto m = small_bgk(8);
  const grid mesh = grid::line(20, 0.0, 1.0);
  for (const auto kind : {limits::nothing, limits::edges, limits::fluxes}) {
    const auto t = upwind(*m, space_of(mesh), scheme("weno5-z", kind));
    const field u = sample(mesh, 8, true, [](double x, int k) { return x < 0.4 ? 1.0 + k : 1e-3; });
    const field change = transport_of(t, u);
    for (int k = 0; k < 8; ++k) {
      double sum = 0.0, scale = 0.0;
      for (int i = 0; i < 20; ++i) {
        sum += change.row(i)[k];
        scale += std::abs(change.row(i)[k]);
      }
      EXPECT_LT(std::abs(sum), 1e-14 * scale + 1e-13) << k;  // sum of 20 differences of rounded fluxes
    }
  }
}

TEST(transport, does_not_depend_on_the_number_of_threads_or_on_blocks) {
  const auto m = small_bgk(150, 15.0);
  const grid mesh = grid::line(97, 0.0, 2.0);
  const auto t = upwind(*m, space_of(mesh), scheme("weno5-z", limits::edges));
  const field u =
      sample(mesh, 150, false, [](double x, int k) { return std::exp(std::sin(3.0 * x) - 0.1 * k); });
  apsis::set_threads(1);
  const field one = transport_of(t, u);
  apsis::set_threads(3);
  const field three = transport_of(t, u);
  apsis::set_threads(1);
  for (int i = 0; i < 97; ++i)
    for (int k = 0; k < 150; ++k) ASSERT_EQ(one.row(i)[k], three.row(i)[k]);
}

TEST(transport, of_many_targets_is_that_of_each_of_them) {
  // The factors of 16 targets are stored. Those of further targets are computed in every cell.
  const auto m = small_bgk(20);
  const grid mesh = grid::line(13, 0.0, 2.0);
  const field u = sample(mesh, 20, false, [](double x, int k) { return 2.0 + std::sin(3.0 * x + k); });
  for (const auto kind : {limits::nothing, limits::fluxes}) {
    const auto t = upwind(*m, space_of(mesh), scheme("weno5-z", kind));
    std::vector<field> together(20, u), alone(20, u);
    std::vector<apsis::target<field, double>> targets;
    for (int k = 0; k < 20; ++k)
      targets.push_back({&together[static_cast<std::size_t>(k)], 0.1 * k, 1e-3 * (k + 1), k % 2 == 0});
    t.add_transport(0.0, u, targets);
    for (std::size_t k = 0; k < targets.size(); ++k) {
      auto one = targets[k];
      one.acc = &alone[k];
      t.add_transport(0.0, u, {&one, 1});
      for (int i = 0; i < mesh.size(); ++i)
        for (int c = 0; c < 20; ++c) ASSERT_EQ(together[k].row(i)[c], alone[k].row(i)[c]) << k;
    }
  }
}

namespace {

/// Advection of three components with given velocities in two dimensions.
class plane_advection final : public apsis::relaxation_model {
 public:
  int components() const override { return 3; }
  int space_dimensions() const override { return 2; }
  const apsis::velocity_set& velocities() const override {
    static const apsis::velocity_set three({{1.0, -0.5, 0.0}, {0.5, 0.0, -2.0}}, {1.0, 1.0, 1.0});
    return three;
  }
  int moment_count() const override { return 1; }
  void moments(const double* u, double* omega) const override { omega[0] = u[0] + u[1] + u[2]; }
  bool equilibrium(const double* omega, double* e) const override {
    for (int k = 0; k < 3; ++k) e[k] = omega[0] / 3.0;
    return true;
  }
  double rate(const double*) const override { return 1.0; }
  std::string why_inadmissible(const double*) const override { return ""; }
  std::vector<std::string> invariants() const override { return {"mass"}; }
  void invariant_densities(const double* u, double* d) const override { moments(u, d); }
  std::vector<apsis::field_group> fields() const override { return {}; }
  const std::vector<apsis::initial_data>& initial() const override {
    static const std::vector<apsis::initial_data> none;
    return none;
  }
};

}  // namespace

TEST(transport, is_fifth_order_in_two_dimensions) {
  const plane_advection m;
  const double w = 2.0 * std::numbers::pi;
  const auto error = [&](int n) {
    const grid mesh(2, {n, n, 1}, {0, 0, 0}, {1, 1, 1});
    const auto t = upwind(m, space_of(mesh), scheme("weno5-z", limits::edges));
    field u(mesh.size(), 3), exact(mesh.size(), 3);
    for (int i = 0; i < mesh.size(); ++i) {
      const double x = mesh.centre(i, 0), y = mesh.centre(i, 1);
      for (int k = 0; k < 3; ++k) {
        const auto component = static_cast<std::size_t>(k);
        u.row(i)[k] = 2.0 + std::sin(w * x) * std::cos(w * y);
        exact.row(i)[k] = -w * (m.speeds(0)[component] * std::cos(w * x) * std::cos(w * y) -
                                m.speeds(1)[component] * std::sin(w * x) * std::sin(w * y));
      }
    }
    const field numerical = transport_of(t, u);
    double sum = 0.0;
    for (int i = 0; i < mesh.size(); ++i)
      for (int k = 0; k < 3; ++k) sum += std::abs(numerical.row(i)[k] - exact.row(i)[k]);
    return sum / mesh.size();
  };
  EXPECT_GT(std::log2(error(40) / error(80)), 4.8);
}

}  // namespace transport_test
