#include <apsis/run/running_case.hpp>

#include <apsis/exec/agreement.hpp>
#include <apsis/mesh/on_host.hpp>
#include <apsis/run/memory_need.hpp>
#include <apsis/run/step_plan.hpp>

#include <algorithm>
#include <utility>

namespace apsis {
namespace {

std::unique_ptr<semidiscrete_problem> problem_of(const run_setup& setup) {
  std::unique_ptr<semidiscrete_problem> problem;
  run_collectively(setup.processes(), [&] { problem = setup.make_problem(); });
  return problem;
}

}  // namespace

running_case::running_case(std::unique_ptr<run_setup> prepared, const state_source& start)
    : made(std::move(prepared)),
      setup(*made),
      config(setup.config()),
      problem(problem_of(setup)),
      watch(setup),
      flows(setup),
      walls(setup),
      rounding(rounding_of(setup)),
      now{moved_to(setup.memory(), start ? start(setup) : setup.initial_state()), {}},
      march(times_of(setup)) {}

void running_case::start_records() {
  first = last = watch.start(state);
  totals.min_value = first.min_value;
  totals.negative_values = first.negative_values;
  watch.watch_velocities(state, first, totals);
  totals.phase_points = static_cast<long>(setup.whole_mesh().size()) * state.components();
}

void running_case::record_position(double dt) {
  last.step = totals.steps = march.step();
  last.t = totals.t = march.t();
  last.dt = dt;
  totals.dt = std::max(totals.dt, dt);
}

numerical_error running_case::located(const numerical_error& failure) const {
  return failure.site().step >= 0 ? failure : failure.at(march.step() + 1, march.t());
}

std::unique_ptr<run_setup> setup_that_fits(const case_config& config,
                                           const std::shared_ptr<communicator>& processes) {
  std::unique_ptr<run_setup> setup;
  run_collectively(*processes, [&] {
    setup = std::make_unique<run_setup>(config, processes);
    check_memory(*setup, 0);
  });
  return setup;
}

std::vector<double> without_padding(const field& state) {
  field room;
  const field& u = on_host(state, room);
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(u.cells()) * static_cast<std::size_t>(u.components()));
  for (int cell = 0; cell < u.cells(); ++cell)
    values.insert(values.end(), u.row(cell), u.row(cell) + u.components());
  return values;
}

void copy_rows(const std::vector<double>& values, field& u) {
  field rows(u.cells(), u.components());
  for (int cell = 0; cell < u.cells(); ++cell)
    std::copy_n(values.data() + static_cast<std::ptrdiff_t>(cell) * u.components(), u.components(),
                rows.row(cell));
  u.copy_rows(rows);
}

}  // namespace apsis
