#include <apsis/run/simulation.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/thread_clock.hpp>
#include <apsis/mesh/on_host.hpp>
#include <apsis/run/compute_fields.hpp>
#include <apsis/run/compute_surfaces.hpp>
#include <apsis/run/progression.hpp>
#include <apsis/run/running_case.hpp>
#include <apsis/run/steady_iterations.hpp>
#include <apsis/run/time_steps.hpp>
#include <apsis/run/whole_budget.hpp>
#include <apsis/semidiscrete/face_fluxes.hpp>
#include <apsis/semidiscrete/gathered_cells.hpp>

#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

std::unique_ptr<progression> make_progression(running_case& run) {
  if (run.config.steady_state.tolerance) return std::make_unique<steady_iterations>(run);
  return std::make_unique<time_steps>(run);
}

struct simulation::impl {
  impl(std::unique_ptr<run_setup> prepared, const state_source& start)
      : run(std::move(prepared), start), progress(make_progression(run)) {
    run.start_records();
    progress->start();
    record_walls();
    run.first.wall_temperature = run.last.wall_temperature;
  }

  /// Returns face_fluxes::observed() at the ends of this process. Returns nothing after a failed step, or if
  /// a boundary has no condition for the state.
  std::optional<std::vector<double>> observe_surfaces() {
    if (inside_step) return std::nullopt;
    try {
      return run.problem->observe_surfaces(run.march.t(), run.state);
    } catch (const error&) {
      return std::nullopt;
    }
  }

  /// Returns observe_surfaces() for the ends of the whole mesh; empty if nothing was observed.
  std::vector<double> observe_all_surfaces() {
    const auto own = observe_surfaces();
    if (!own) return {};
    return whole_ends(run.setup, *own,
                      face_fluxes::observed_moments * run.setup.equation->invariants().size());
  }

  /// Enters the temperatures of walls into the last record.
  void record_walls() {
    if (run.walls.size() > 0)
      run.last.wall_temperature =
          run.walls.of(run.march.t(), observe_surfaces().value_or(std::vector<double>{}));
  }

  running_case run;
  std::unique_ptr<progression> progress;
  bool inside_step = false;  ///< true also after a failed step
  std::vector<double> row;   ///< copy of a row of a state on a device
};

namespace {

void check_sizes(const run_setup& setup, const kept_value& saved, const field& u) {
  if (saved.unknowns.size() != static_cast<std::size_t>(u.cells()) * static_cast<std::size_t>(u.components()))
    throw input_error(
        "the saved state has another size than the case (it belongs to another case); restart with the case "
        "it was written for");
  if (!saved.budget.empty() && saved.budget.size() != size_of_whole_budget(setup))
    throw input_error(
        "the saved boundary budget has another size than that of the case (it belongs to another case); "
        "restart with the case it was written for");
}
}  // namespace

simulation::simulation(const case_config& config, const state_source& start,
                       const std::shared_ptr<communicator>& processes)
    : simulation(setup_that_fits(config, processes), start) {}
simulation::simulation(std::unique_ptr<run_setup> setup, const state_source& start)
    : impl_(std::make_unique<impl>(std::move(setup), start)) {}
simulation::~simulation() = default;
simulation::simulation(simulation&&) noexcept = default;
simulation& simulation::operator=(simulation&&) noexcept = default;

const case_config& simulation::config() const {
  return impl_->run.config;
}
const run_setup& simulation::setup() const {
  return impl_->run.setup;
}
const run_promises& simulation::promises() const {
  return impl_->run.promises;
}
double simulation::t() const {
  return impl_->run.march.t();
}
double simulation::dt() const {
  return impl_->run.march.done() ? 0.0 : impl_->progress->next_dt();
}
long simulation::step() const {
  return impl_->run.march.step();
}
long simulation::steps_total() const {
  return finished() ? step() : step() + impl_->progress->steps_left();
}
long simulation::snapshot_times_passed() const {
  const double every = config().output.every;
  return every > 0.0 ? multiples_until(t(), every) : 0;
}
bool simulation::next_step_depends_on_end() const {
  return impl_->progress->next_step_depends_on_end();
}
double simulation::limiter_share() const {
  return impl_->progress->limiter_share();
}
double simulation::expected_loss() const {
  return impl_->progress->expected_loss();
}
double simulation::expected_plateau() const {
  return impl_->progress->expected_plateau();
}
bool simulation::finished() const {
  return impl_->progress->finished();
}

const step_record& simulation::advance() {
  const auto start = std::chrono::steady_clock::now();
  const double cpu = thread_seconds();
  running_case& run = impl_->run;
  impl_->inside_step = true;
  impl_->progress->advance();
  impl_->inside_step = false;
  impl_->record_walls();
  run.totals.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  run.totals.cpu_s += thread_seconds() - cpu;
  impl_->progress->check();
  if (!impl_->progress->watches_velocities()) run.watch.watch_velocities(run.state, run.last, run.totals);
  run.flows.update(run.last);
  return run.last;
}

bool simulation::may_continue() const {
  return config().steady_state.tolerance && !impl_->inside_step;
}

const step_record& simulation::last() const {
  return impl_->run.last;
}
const step_record& simulation::initial_record() const {
  return impl_->run.first;
}

run_summary simulation::summary() const {
  run_summary summary = impl_->run.totals;
  summary.rejected_steps = impl_->progress->rejected_steps();
  const double work = static_cast<double>(summary.phase_points) *
                      static_cast<double>(summary.steps + summary.rejected_steps) *
                      static_cast<double>(impl_->progress->stages_of_step());
  summary.t = t();
  summary.startup_steps = impl_->run.march.startup_steps();
  summary.point_stages_per_s = summary.wall_s > 0.0 ? work / summary.wall_s : 0.0;
  return summary;
}

field_table simulation::fields() const {
  field room;
  return compute_fields(impl_->run.setup, impl_->run.setup.densities(impl_->run.state, room));
}

std::vector<surface_table> simulation::surfaces() const {
  if (config().output.surfaces.empty()) return {};
  const std::vector<double> budget = whole_budget(impl_->run.setup, impl_->run.budget),
                            observed = impl_->observe_all_surfaces();
  if (!processes().is_root()) return {};
  return compute_surfaces(impl_->run.setup, {t(), last().dt, budget, observed});
}

const grid& simulation::mesh() const {
  return impl_->run.setup.whole_mesh();
}
communicator& simulation::processes() const {
  return impl_->run.setup.processes();
}

std::vector<double> simulation::state() const {
  field room;
  return without_padding(impl_->run.setup.densities(impl_->run.state, room));
}

std::vector<double> simulation::whole_state() const {
  return gather_cells(impl_->run.setup.builder(), state(), impl_->run.state.components());
}

std::span<const double> simulation::row(int cell) const {
  return row_on_host(impl_->run.state, cell, impl_->row);
}

std::vector<double> simulation::densities_in(int cell) const {
  const grid& block = impl_->run.setup.mesh();
  const double r = block.solid(cell) < 0 ? block.radius(block.centre(cell)) : 1.0;
  std::vector<double> f(row(cell).begin(), row(cell).end());
  for (double& value : f) value /= r;
  return f;
}

std::vector<double> simulation::exact_state() const {
  const auto exact = impl_->run.setup.exact_state(t());
  field room;
  return exact ? without_padding(impl_->run.setup.densities(*exact, room)) : std::vector<double>{};
}

std::vector<double> simulation::epsilon() const {
  return gather_cells(impl_->run.setup.builder(), impl_->run.setup.epsilon_at_centres());
}

run_state simulation::save() const {
  const running_case& run = impl_->run;
  run_state saved;
  saved.unknowns = without_padding(run.state);
  saved.march = run.march.save();
  impl_->progress->save(saved);
  saved.totals = summary();
  // Every process measures these times; the root's are saved.
  std::array<double, 2> seconds = {saved.totals.wall_s, saved.totals.cpu_s};
  processes().broadcast(std::as_writable_bytes(std::span(seconds)));
  saved.totals.wall_s = seconds[0];
  saved.totals.cpu_s = seconds[1];
  saved.initial = run.first;
  saved.last = run.last;
  saved.budget = whole_budget(run.setup, run.budget);
  return saved;
}

void simulation::restore(const run_state& saved) {
  running_case& run = impl_->run;
  check_sizes(run.setup, {saved.unknowns, saved.budget}, run.state);
  for (const kept_value& kept : saved.kept) check_sizes(run.setup, kept, run.state);
  copy_rows(saved.unknowns, run.state);
  run.watch.forget_steps();
  // Before the first step, the marcher of the case is the right one.
  if (saved.march.step > 0) run.march.resume(saved.march);
  impl_->progress->restore(saved);
  run.totals = saved.totals;
  run.first = saved.initial;
  run.last = saved.last;
  run.budget = own_budget(run.setup, saved.budget);
  run.now.budget = boundary_budget(run.budget);  // the next step shifts budgets of kept values by it
}

}  // namespace apsis
