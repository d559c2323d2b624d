#include "clock.hpp"
#include "mixed_step.hpp"

#include <apsis/config/discretization_of_case.hpp>
#include <apsis/mesh/on_host.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace apsis::bench {

namespace {

case_config mixed_case(const std::string& discretization, const std::string& method, int cells,
                       std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(), {discretization_override(discretization), "time.method=" + method,
                                       "space.cells=" + std::to_string(cells)});
  return load_case("paper/bgk-mixed", overrides);
}

}  // namespace

mixed_step::mixed_step(const std::string& discretization, const std::string& method, int cells,
                       std::vector<std::string> overrides)
    : mixed_step(mixed_case(discretization, method, cells, std::move(overrides))) {}

mixed_step::mixed_step(const case_config& config, std::shared_ptr<device> on)
    : on_(std::move(on)),
      setup_(config, single_process(), on_),
      problem_(setup_.make_problem()),
      stepper_(setup_.integrator().starter(), *problem_),
      u_(moved_to(setup_.memory(), setup_.initial_state())),
      fuses_solves_(setup_.builder().collisions().cellwise),
      dt_(0.9 * stepper_.r() * problem_->forward_euler_step(0.0, u_)) {
  take(1);  // allocates the buffers
}

kernel_work mixed_step::count_work() {
  profile::start();
  take(1);
  profile::stop();
  kernel_work sum;
  for (const auto& done : profile::read()) {
    sum.operations += done.operations;
    sum.bytes += done.bytes;
  }
  return sum;
}

sweep_work mixed_step::count_sweeps() {
  profile::start();
  take(1);
  profile::stop();
  sweep_work sweeps{};
  double all = 0.0;
  for (const auto& done : profile::read()) {
    all += done.seconds;
    if (done.which == kernel::edges || done.which == kernel::fluxes) sweeps.share += done.seconds;
    if (done.which != kernel::fluxes) continue;
    constexpr double read_and_written = 2.0 * sizeof(double);
    sweeps.numbers = done.numbers;
    sweeps.accumulators = static_cast<int>(std::lround(done.bytes / done.numbers / read_and_written));
  }
  sweeps.share /= all;
  return sweeps;
}

double mixed_step::point_stages() const {
  return static_cast<double>(u_.cells()) * u_.components() *
         static_cast<double>(setup_.integrator().starter().stages());
}

double mixed_step::subnormal_share() const {
  double count = 0.0;
  for (int cell = 0; cell < u_.cells(); ++cell)
    for (int k = 0; k < u_.components(); ++k)
      if (std::fpclassify(u_.row(cell)[k]) == FP_SUBNORMAL) ++count;
  return count / (static_cast<double>(u_.cells()) * u_.components());
}

int mixed_step::passes() const {
  const auto& plan = stepper_.plan();
  return static_cast<int>(plan.instructions().size()) - (fuses_solves_ ? plan.implicit_solves() : 0);
}

int mixed_step::steps_in(double seconds) {
  const double start = wall_seconds();
  take(1);
  return std::max(1, static_cast<int>(seconds / (wall_seconds() - start)));
}

}  // namespace apsis::bench
