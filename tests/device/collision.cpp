#include "device_case.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/device/internal/device_collision.hpp>

#include <array>

#include <gmock/gmock.h>

namespace device_collision_test {

using apsis::equilibrium_choice;
using apsis::field;
using apsis::stage_solution;

struct variant {
  int points;
  double max;
  bool by_viscosity;
  equilibrium_choice choice;
};

std::unique_ptr<apsis::model> gas(const variant& of, const std::string& name = "bgk") {
  apsis::model_config config = apsis::default_config(apsis::find_model(name));
  config.velocity = {of.max, of.points, of.choice};
  if (of.by_viscosity) config.options["collision_rate"] = "viscosity";
  return apsis::find_model(name).make(config);
}

/// Two beams of changing density, velocity and temperature; some cells are cold, nearly empty, or near the
/// ends of the velocities, where the equilibrium is not a formula.
field beams(const apsis::model& equation, int cells) {
  field u(cells, equation.components());
  const auto v = equation.speeds(0);
  for (int i = 0; i < cells; ++i)
    for (std::size_t k = 0; k < v.size(); ++k) {
      const double T = i % 7 == 3 ? 0.01 : 0.5 + 0.04 * i, centre = i % 11 == 5 ? 6.0 : 0.1 * i - 1.0;
      const double rho = i % 13 == 6 ? 1e-290 : 1.0 + 0.1 * i;
      u.row(i)[k] = rho * (std::exp(-(v[k] - centre) * (v[k] - centre) / (2.0 * T)) +
                           0.3 * std::exp(-(v[k] + 0.5) * (v[k] + 0.5) / T));
    }
  return u;
}

constexpr variant variants[] = {
    {40, 8.0, false, equilibrium_choice::automatic},   {45, 8.0, true, equilibrium_choice::automatic},
    {150, 15.0, false, equilibrium_choice::automatic}, {150, 15.0, true, equilibrium_choice::formula},
    {21, 5.0, false, equilibrium_choice::formula},     {700, 12.0, false, equilibrium_choice::automatic},
};

TEST(device_collision, has_the_bits_of_the_host_in_every_order_of_lanes) {
  constexpr int cells = 37;
  for (const variant& of : variants) {
    const auto equation = gas(of);
    std::vector<double> epsilon;
    for (int i = 0; i < cells; ++i) epsilon.push_back(i % 5 == 0 ? 0.0 : std::pow(10.0, 2 - i % 9));
    const field u = beams(*equation, cells);
    const apsis::grid mesh = apsis::grid::line(cells, 0.0, 1.0);
    for (const auto& on : tested_devices()) {
      const auto host = apsis::make_pointwise_collision(*equation, epsilon);
      apsis::device_collision there(*on, *equation, epsilon, false, {}, stage_solution::implicit);
      for (const std::array<double, 2> step :
           {std::array{0.1, 0.0}, std::array{0.02, -0.01}, std::array{0.0, -3.0}}) {
        field here = u, away(cells, u.components(), on->memory()), back(cells, u.components());
        away.copy_rows(u);
        host->solve(0.0, step[0], step[1], here);
        there.solve(0.0, step[0], step[1], away);
        back.copy_rows(away);
        EXPECT_EQ(different_numbers(mesh, here, back), 0)
            << of.points << " velocities, a = " << step[0] << ", b = " << step[1];
      }
    }
  }
}

TEST(device_collision, rates_and_times_are_those_of_the_host) {
  const auto equation = gas(variants[1]);
  const std::vector<double> epsilon(6, 0.3);
  const field u = beams(*equation, 3);
  const auto& on = tested_device();
  const std::vector<double> three(3, 0.3);
  const auto host = apsis::make_pointwise_collision(*equation, three);
  apsis::device_collision there(*on, *equation, three, false, {}, stage_solution::implicit);
  field away(3, u.components(), on->memory());
  away.copy_rows(u);
  EXPECT_EQ(there.relaxation_time(away), host->relaxation_time(u));
  EXPECT_EQ(there.forward_euler_step(away), host->forward_euler_step(u));
  for (const bool fresh : {true, false}) {
    field here = u, acc = away, back(3, u.components());
    const apsis::target<field, double> to{&here, 0.5, 0.25, fresh}, to_device{&acc, 0.5, 0.25, fresh};
    host->add_collision(0.0, u, {&to, 1});
    there.add_collision(0.0, away, {&to_device, 1});
    back.copy_rows(acc);
    EXPECT_EQ(different_numbers(apsis::grid::line(3, 0.0, 1.0), here, back), 0);
  }
}

/// The host names the cell of a row without equilibrium.
TEST(device_collision, fails_like_the_host_where_there_is_no_equilibrium) {
  const auto equation = gas(variants[0]);
  field u = beams(*equation, 5);
  for (int k = 0; k < u.components(); ++k) u.row(3)[k] = -1.0;
  const auto& on = tested_device();
  apsis::device_collision there(*on, *equation, std::vector<double>(5, 0.1), false, {},
                                stage_solution::implicit);
  field away(5, u.components(), on->memory());
  away.copy_rows(u);
  try {
    there.solve(0.0, 0.1, 0.0, away);
    FAIL() << "no error";
  } catch (const apsis::numerical_error& failure) {
    EXPECT_EQ(failure.site().cell, 3);
  }
}

TEST(device_collision, refuses_what_it_has_no_kernel_for) {
  const auto& on = tested_device();
  const auto make = [&](const apsis::model& equation, stage_solution stages) {
    apsis::device_collision(*on, equation, {0.1}, false, {}, stages);
  };
  const auto bgk = gas(variants[0]), shakhov = gas(variants[0], "shakhov");
  EXPECT_THAT(
      [&] { make(*shakhov, stage_solution::implicit); },
      testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("kernel of its collisions is missing")));
  EXPECT_THAT([&] { make(*bgk, stage_solution::exact); },
              testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("exact collisions")));
}

}  // namespace device_collision_test
