// Outflow ends of a domain: waves leave without reflection, and values stay nonnegative.
#include "bgk_case.hpp"

#include <apsis/semidiscrete/collision.hpp>

namespace outflow_test {

namespace {

using apsis::field;
using apsis::grid;
using limits = apsis::limited_reconstruction::limits;

std::unique_ptr<apsis::relaxation_model> broadwell() {
  auto made = apsis::find_model("broadwell").make({});
  return std::unique_ptr<apsis::relaxation_model>(dynamic_cast<apsis::relaxation_model*>(made.release()));
}

struct choice {
  const char* scheme;
  limits positivity;
};
constexpr choice choices[] = {{"upwind1", limits::nothing},
                              {"weno5-z", limits::edges},
                              {"weno5-z", limits::fluxes},
                              {"weno5-js", limits::edges},
                              {"teno5", limits::fluxes}};

}  // namespace

TEST(outflow, a_step_of_dt_fe_keeps_any_data_nonnegative_in_floating_point) {
  const auto m = broadwell();
  const grid mesh = grid::line(7, 0.0, 1.0);  // the stencil of every cell reaches an end
  for (const auto& c : choices) {
    const auto t = upwind(*m, space_of(mesh, "outflow"), scheme(c.scheme, c.positivity));
    check_property(c.scheme, [&] {
      const field u = random_rows(mesh, 3);
      field result(mesh.size(), 3);
      const apsis::target<field, double> to{&result, 1.0, t.forward_euler_step(), true};
      t.add_transport(0.0, u, {&to, 1});
      RC_ASSERT(smallest(result) >= 0.0);
    });
  }
}

TEST(outflow, collisions_in_cells_keep_any_data_nonnegative) {
  const auto m = broadwell();
  const grid mesh = grid::line(7, 0.0, 1.0);
  check_property("collisions of any strength", [&] {
    field u = random_rows(mesh, 3);
    const double epsilon = std::pow(10.0, *rc::gen::inRange(-12, 3));
    const auto q = apsis::make_cell_average_collision(
        *m, space_of(mesh, "outflow"), scheme("weno5-z", limits::edges), std::vector<double>(21, epsilon));
    q->solve(0.0, *rc::gen::element(0.0, 0.1), -*rc::gen::element(0.0, 0.1), u);
    RC_ASSERT(smallest(u) >= 0.0);
  });
}

TEST(outflow, uniform_data_do_not_change) {
  const auto m = broadwell();
  const grid mesh = grid::line(9, 0.0, 1.0);
  for (const auto& c : choices) {
    const auto t = upwind(*m, space_of(mesh, "outflow"), scheme(c.scheme, c.positivity));
    const field change = transport_of(t, sample(mesh, 3, false, [](double, int k) { return 0.1 + k; }));
    // Differences of equal fluxes have the rounding error of edge values over Δx = 1/9.
    for (int i = 0; i < 9; ++i)
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(change.row(i)[k], 0.0, 1e-13) << c.scheme;
  }
}

TEST(outflow, a_pulse_leaves_without_reflection) {
  // Pulses fly freely from the left or the right end across the whole domain.
  const auto m = broadwell();
  const grid mesh = grid::line(60, 0.0, 1.0);
  const auto pulse = [](double x) { return std::exp(-400.0 * x * x); };
  for (const auto& c : choices) {
    const auto t = upwind(*m, space_of(mesh, "outflow"), scheme(c.scheme, c.positivity));
    field u = sample(mesh, 3, true, [&](double x, int k) { return pulse(x - (k == 0 ? 0.3 : 0.7)); });
    const double start = total(*m, u, 0);
    double inside = start;
    const double dt = 0.5 * t.forward_euler_step();
    for (double now = 0.0; now < 2.0; now += dt) {
      field next(60, 3);
      const apsis::target<field, double> to{&next, 1.0, dt, true};
      t.add_transport(0.0, u, {&to, 1});
      u = next;
      const double mass = total(*m, u, 0);
      EXPECT_LE(mass, inside * (1.0 + 1e-13)) << "mass comes in";
      inside = mass;
    }
    // Only the particles at rest remain. They do not change.
    double moving = 0.0;
    for (int i = 0; i < 60; ++i) moving += u.row(i)[0] + u.row(i)[2];
    EXPECT_LT(moving, 1e-10 * start) << c.scheme;
  }
}

}  // namespace outflow_test
