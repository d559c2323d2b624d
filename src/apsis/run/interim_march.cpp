#include <apsis/run/interim_march.hpp>

#include <apsis/config/limiter_of_case.hpp>
#include <apsis/config/method_of_case.hpp>

#include <algorithm>
#include <memory>
#include <utility>

namespace apsis {
namespace {

constexpr double parts = 20.0;

case_config in_time(case_config config, double duration) {
  config.steady_state.tolerance.reset();
  config.time = {};
  config.time.end = duration;
  config.time.safety = 1.0;
  config.output = {};
  config = with_chosen_method(std::move(config));
  if (!config.given.contains("space.limiter")) config.space.limiter = default_limiter(config);
  return config;
}

std::shared_ptr<communicator> processes_of(const run_setup& setup) {
  const auto& blocks = setup.builder().blocks();
  return blocks ? blocks->processes : single_process();
}

}  // namespace

interim_march::interim_march(const run_setup& setup, const field& start, double duration)
    : part_(duration / parts),
      run_(
          in_time(setup.config(), duration), [&start](const run_setup&) { return start; },
          processes_of(setup)) {}

void interim_march::advance(field& u) {
  const double end = run_.t() + part_;
  while (!run_.finished() && run_.t() < end) run_.advance();
  for (int cell = 0; cell < u.cells(); ++cell)
    std::copy_n(run_.row(cell).data(), u.components(), u.row(cell));
}

}  // namespace apsis
