#include "device_case.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/device/on_device.hpp>
#include <apsis/integrate/any_stepper.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>

#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace device_problem_test {

using apsis::field;

std::unique_ptr<apsis::model> gas(bool by_viscosity) {
  apsis::model_config config = apsis::default_config(apsis::find_model("bgk"));
  config.velocity = {8.0, 40, apsis::equilibrium_choice::automatic};
  if (by_viscosity) config.options["collision_rate"] = "viscosity";
  return apsis::find_model("bgk").make(config);
}

apsis::problem_builder builder_of(const apsis::model& equation, bool between_walls) {
  apsis::problem_builder builder(equation);
  builder.on(apsis::grid::line(24, 0.0, 2.0))
      .with_reconstruction(apsis::find_reconstruction("weno5-z").make());
  builder.with_discretization("finite-difference")
      .with_positivity_limiter()
      .with_epsilon([](const apsis::position& x) { return x[0] < 1.0 ? 1e-4 : 0.5; });
  if (between_walls)
    for (const bool upper : {false, true})
      builder.with_boundary({0, upper},
                            apsis::make_boundary("diffuse", equation, {{"T", {upper ? 1.3 : 0.8}}}));
  return builder;
}

/// Takes two steps of a method of one step, and one more of a method of several steps than its starter takes.
void take_steps(const apsis::time_integrator& of, apsis::semidiscrete_problem& problem, field& u) {
  if (of.starter().kind == apsis::method_kind::explicit_only) problem.treat_collision_explicitly();
  const double r = of.ssp_coefficient > 0.0 ? of.ssp_coefficient : 1.0;
  const double dt = 0.5 * r * problem.forward_euler_step(0.0, u);
  apsis::time_marcher<double> march(0.0, (of.steps + 1) * dt, dt);
  const auto stepper = apsis::make_stepper(of, problem);
  while (!march.done()) {
    const double step = march.next(dt);
    stepper->step(march, step, u);
    march.advance(step);
  }
}

/// Counts the numbers that differ after steps on the host and on a device.
bit_differences differences(const apsis::time_integrator& steps, bool between_walls) {
  const auto equation = gas(between_walls);
  const auto builder = builder_of(*equation, between_walls);
  const auto& card = tested_device();
  auto on_card = builder_of(*equation, between_walls);
  on_card.with_discretization(apsis::on_device(*card, "weno5-z"));
  field here = builder.sample(equation->initial().front().point_value), back(here.cells(), here.components());
  field away(here.cells(), here.components(), card->memory());
  away.copy_rows(here);
  const auto host = builder.build(), device = on_card.build();
  take_steps(steps, *host, here);
  take_steps(steps, *device, away);
  back.copy_rows(away);
  return different_numbers(builder.mesh(), here, back);
}

/// Exact collisions have no kernel, and implicit methods have no transport.
TEST(device_problem, steps_of_every_integrator_have_the_bits_of_the_host) {
  bool between_walls = false;
  for (const std::string& name : apsis::integrator_names()) {
    const apsis::time_integrator& integrator = apsis::find_integrator(name);
    if (integrator.needs.exact_collision || integrator.starter().kind == apsis::method_kind::implicit_only)
      continue;
    // The kernels are the same for all integrators, so that every other one suffices for each kind of ends.
    EXPECT_EQ(differences(integrator, between_walls), 0)
        << name << (between_walls ? " between walls" : " in a periodic domain");
    between_walls = !between_walls;
  }
}

TEST(device_problem, is_refused_with_a_reason_where_a_kernel_is_missing) {
  const auto equation = gas(false);
  const auto& card = tested_device();
  const auto build = [&](auto change) {
    auto builder = builder_of(*equation, false);
    builder.with_discretization(apsis::on_device(*card, "weno5-z"));
    change(builder);
    builder.build();
  };
  EXPECT_THAT([&] { build([&](auto& b) { b.with_exact_collision(); }); },
              testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("exact collisions")));
  EXPECT_THAT([&] { build([&](auto& b) { b.with_discretization(apsis::on_device(*card, "weno9")); }); },
              testing::ThrowsMessage<apsis::input_error>(
                  testing::HasSubstr("\"weno9\" is not possible on a device")));
}

}  // namespace device_problem_test
