#include <apsis/run/step_plan.hpp>

#include <apsis/config/at_place.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/integrate/guarded_newton.hpp>
#include <apsis/method/rate_errors.hpp>
#include <apsis/method/steady_states.hpp>
#include <apsis/run/state_distance.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace apsis {

time_marcher<double> times_of(const run_setup& setup) {
  const case_config& config = setup.config();
  const auto dt = setup.given_dt();
  const double every = config.output.every;
  auto march = at_place(place_of(config, "time.dt"), [&] {
    return time_marcher<double>(0.0, config.time.end, dt, config.time.startup_growth);
  });
  try {
    march.stop_every(every);
    if (march.adjusted())
      log::warning(
          fmt::format("time.dt = {:.17g} does not divide time.end = {:g}; dt = {:.17g} is used instead", *dt,
                      config.time.end, *march.fixed_dt()));
  } catch (const input_error&) {
    log::warning(
        fmt::format("time.dt = {:.17g} does not divide output.every = {:g} (steps are shortened to end at "
                    "every snapshot); "
                    "give one that does for steps of equal length",
                    *dt, every));
    march = time_marcher<double>(0.0, config.time.end, std::nullopt, config.time.startup_growth);
    march.stop_every(every);
  }
  return march;
}

void warn_of_stiff_collision(const run_setup& setup, double relaxation, double dt) {
  if (setup.integrator().starter().kind != method_kind::explicit_only) return;
  const double end = setup.config().time.end, steps = end / std::min(relaxation, dt);
  if (steps > 1e8)
    log::warning(fmt::format(
        "method '{}' is explicit and stable in steps of about epsilon/C = {:.1g} only, about {:.1g} of them "
        "to time.end = {:g} (the collision is stiff); choose an IMEX method such as md-imex-8-3-mixed",
        setup.integrator().name, relaxation, steps, end));
  else if (!setup.has_tolerance() && !std::isfinite(setup.integrator().errors_at(dt / relaxation).flux))
    log::warning(fmt::format(
        "method '{}' is explicit and unstable in steps of {:.2g} (they are {:.2g} times as long as the "
        "relaxation time epsilon/C); choose an IMEX method such as md-imex-8-3-mixed, or give time.dt below "
        "{:.1g}",
        setup.integrator().name, dt, dt / relaxation, relaxation));
}

void warn_of_fast_source(double growth, double dt) {
  if (!(growth * dt > 1.0)) return;
  log::warning(fmt::format(
      "the source is too fast for the step (it is explicit, and dt times its derivative in the variables is "
      "{:.2g}, where explicit steps are stable up to about 1); give a time.dt or time.cfl that is {:.2g} "
      "times "
      "as long, or time.safety, which includes the source",
      growth * dt, 1.0 / (growth * dt)));
}

void warn_of_dense_stages(const run_setup& setup) {
  const int n = setup.equation->newton_unknowns();
  if (n <= static_cast<int>(most_unknowns_of_newton) ||
      setup.integrator().starter().kind == method_kind::explicit_only)
    return;
  log::warning(
      fmt::format("a collision has {} unknowns, and each Newton step of a stage takes about n^3 = {:.0e} "
                  "operations at every "
                  "point (its linear systems are dense); choose a model whose stages are closed formulas, "
                  "such as bgk, or "
                  "fewer velocities",
                  n, std::pow(static_cast<double>(n), 3)));
}

void warn_of_moved_steady_state(const run_setup& setup, double relaxation, double dt) {
  // In plane Couette flow the stress of md-imex-10-3-long is off by 6e-7, 3e-4 and 9e-4 at dt C/epsilon =
  // 0.03, 0.3 and 3. Errors of other flows may be larger.
  constexpr double harmless = 1.0;
  const time_integrator& of = setup.integrator();
  const bool one_step = of.starter().name == of.name,
             relaxes = of.starter().kind != method_kind::explicit_only;
  if (!setup.config().time.steady || !one_step || !relaxes || !(dt > harmless * relaxation)) return;
  constexpr double rounding = 1e-12;
  if (steady_state_defect(to_butcher(of.form)) < rounding) return;
  log::warning(fmt::format(
      "the steady state of method '{}' depends on dt C/epsilon, which is up to {:.2g} here (second "
      "derivatives "
      "of SSP methods move it; the stress of plane Couette flow is off by 9e-4 at 3); use a table [steady], "
      "time.method = \"bhr-553\", or steps below {:.1g}",
      of.name, dt / relaxation, 0.1 * relaxation));
}

void warn_of_layer(const run_setup& setup, semidiscrete_problem& problem, const field& u, double relaxation,
                   double dt) {
  const auto& form = setup.integrator().form;
  const bool solves_first = form.D(0, 0) != 0.0 || form.ddot[0] != 0.0;
  const bool is_imex = setup.integrator().starter().kind == method_kind::imex;
  if (solves_first || !is_imex || setup.has_graded_start() || !(dt > relaxation)) return;
  field equilibrium = u, changed = u;
  problem.project_to_equilibrium(0.0, equilibrium);
  const target<field, double> add{&changed, 0.0, dt, false}, subtract{&changed, 0.0, -dt, false};
  problem.add_transport(0.0, u, {&add, 1});
  problem.add_transport(0.0, equilibrium, {&subtract, 1});
  problem.throw_late_errors();
  const double error = relative_distance(u, changed, setup.processes(), setup.runs_on());
  if (!(error > *setup.config().time.tolerance)) return;
  log::warning(
      fmt::format("method '{}' does not resolve the initial layer of data off equilibrium in a first step of "
                  "{:.1g} (it is "
                  "asymptotic preserving for consistent data only; the layer leaves a relative error of up "
                  "to about {:.1g}, "
                  "which time.tolerance does not see); give time.startup = \"graded\"",
                  setup.integrator().name, dt, error));
}

void warn_of_plateau(const run_setup& setup, const tolerance_forecast<double>& expected, double relaxation) {
  const double tolerance = *setup.config().time.tolerance;
  if (!(expected.error > tolerance)) return;
  const bool right_terms = setup.integrator().starter().claims.intermediate == "all";
  log::warning(fmt::format(
      "time.tolerance = {:g} is below what method '{}' keeps in steps of about {:.1g} (its terms of size "
      "epsilon leave a relative error of up to about {:.1g}); {}give time.dt below {:.1g} to resolve the "
      "relaxation, or a larger tolerance",
      tolerance, setup.integrator().name, expected.dt, expected.error,
      right_terms ? "" : "choose a method with the right terms, such as md-imex-8-3-mixed, ",
      0.1 * std::min(relaxation, expected.dt)));
}

}  // namespace apsis
