#include "compared_transport.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>

#include <gmock/gmock.h>

namespace device_force_test {

using apsis::field;
using apsis::grid;
using apsis::target;
using limits = apsis::limited_reconstruction::limits;

struct variant {
  std::vector<int> points;  ///< velocities in every direction
  int degrees;              ///< degrees of freedom
  std::string scheme;
  limits limited;

  std::string label() const {
    std::string text = scheme + (limited == limits::nothing ? "" : " limited");
    for (const int n : points) text += " " + std::to_string(n);
    return text + ", " + std::to_string(degrees) + " degrees of freedom";
  }
};

std::unique_ptr<apsis::model> gas(const variant& of, const std::vector<std::string>& set = {}) {
  apsis::model_config config = apsis::default_config(apsis::find_model("bgk"));
  config.velocity = {4.0, of.points, apsis::equilibrium_choice::automatic, set};
  config.parameters["velocity_dimensions"] = static_cast<double>(of.points.size());
  config.parameters["degrees_of_freedom"] = of.degrees;
  return apsis::find_model("bgk").make(config);
}

/// Returns a periodic line of cells.
std::shared_ptr<apsis::domain> line(const grid& mesh, const apsis::model& equation) {
  const auto side = apsis::make_boundary("periodic");
  const std::vector<apsis::domain::faces> sides = {{side, side}};
  return std::make_shared<apsis::domain>(apsis::phase_space(mesh, equation.velocities()), sides);
}

/// Returns an acceleration of either sign, zero in some directions and cells.
apsis::acceleration changing(const apsis::model& equation) {
  apsis::acceleration of;
  const std::size_t directions = equation.lattice().points.size();
  std::fill_n(of.largest.begin(), directions, 0.6);
  of.value = [directions](double t, const apsis::position& x) {
    std::array<double, 3> a{};
    for (std::size_t k = 0; k < directions; ++k) {
      const double wave = 0.5 * std::cos(5.0 * x[0] + t + 2.0 * static_cast<double>(k));
      a[k] = x[0] > 0.7 ? 0.0 : wave > 0.3 ? 0.0 : wave;
    }
    return a;
  };
  return of;
}

TEST(device_force, has_the_bits_of_the_host_in_every_order_of_lanes) {
  const grid mesh = grid::line(37, 0.0, 1.0);
  for (const variant& of : {variant{{21}, 1, "weno5-z", limits::nothing},
                            {{40}, 3, "weno5-z", limits::fluxes},
                            {{9, 14}, 2, "weno5-z", limits::fluxes},
                            {{12, 5}, 3, "upwind5", limits::nothing},
                            {{8, 10}, 3, "upwind1", limits::nothing},
                            {{6, 7, 9}, 3, "weno5-z", limits::fluxes},
                            {{6, 7, 5}, 5, "weno5-z", limits::nothing}}) {
    const auto equation = gas(of);
    const apsis::limited_reconstruction edges{apsis::find_reconstruction(of.scheme).make(), of.limited};
    const field u = varied_rows(mesh, *equation, of.limited == limits::fluxes);
    for (const auto& on : tested_devices()) {
      apsis::upwind_transport host(*equation, line(mesh, *equation), edges, apsis::point_values());
      apsis::device_transport there(*on, *equation, line(mesh, *equation), edges, apsis::point_values(),
                                    apsis::kernel_of_reconstruction(of.scheme));
      host.set_force(changing(*equation));
      there.set_force(changing(*equation));
      EXPECT_EQ(host.forward_euler_step(), there.forward_euler_step());
      EXPECT_EQ(differences_of_transport(mesh, u, host, there, *on), 0) << of.label();
    }
  }
}

/// The force changes the state, so the comparison above covers more than sweeps.
TEST(device_force, gives_momentum) {
  const variant of{{21}, 1, "weno5-z", limits::nothing};
  const auto equation = gas(of);
  const grid mesh = grid::line(8, 0.0, 1.0);
  const auto& on = tested_device();
  apsis::device_transport there(*on, *equation, line(mesh, *equation),
                                {apsis::find_reconstruction(of.scheme).make(), of.limited},
                                apsis::point_values(), apsis::kernel_of_reconstruction(of.scheme));
  there.set_force(
      {[](double, const apsis::position&) { return std::array{0.25, 0.0, 0.0}; }, {0.25, 0.0, 0.0}});
  field row(mesh.size(), equation->components()), sent(mesh.size(), equation->components(), on->memory()),
      rate = sent;
  apsis::fluid_state state;
  state.rho = 2.0;
  state.T = 0.15;
  for (int cell = 0; cell < mesh.size(); ++cell)
    equation->as_gas()->molecules().formula(state, 1.0, row.row(cell));
  sent.copy_rows(row);
  std::array<double, 3> of_row{};
  equation->as_gas()->molecules().moments(row.row(0), 0, 1, of_row.data());
  const target<field, double> to{&rate, 0.0, 1.0, true};
  there.add_transport(0.0, sent, {&to, 1});
  row.copy_rows(rate);
  for (int cell = 0; cell < mesh.size(); ++cell) {
    std::array<double, 3> omega{};
    equation->as_gas()->molecules().moments(row.row(cell), 0, 1, omega.data());
    // The momentum is ρa up to the rounding of sums, because the velocities end 10 thermal speeds away.
    EXPECT_NEAR(omega[1], 0.25 * of_row[0], 1e-14);
  }
}

TEST(device_force, is_refused_where_velocities_are_not_even) {
  const variant of{{20}, 1, "weno5-z", limits::nothing};
  const auto equation = gas(of, {"graded"});
  const grid mesh = grid::line(8, 0.0, 1.0);
  apsis::device_transport there(*tested_device(), *equation, line(mesh, *equation),
                                {apsis::find_reconstruction(of.scheme).make(), of.limited},
                                apsis::point_values(), apsis::kernel_of_reconstruction(of.scheme));
  EXPECT_THAT([&] { there.set_force(changing(*equation)); },
              testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("equal distances")));
}

}  // namespace device_force_test
