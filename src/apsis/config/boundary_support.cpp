#include <apsis/config/boundary_support.hpp>

#include <apsis/config/boundary_reader.hpp>
#include <apsis/config/emitted_values.hpp>
#include <apsis/config/source_reader.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/velocity/velocity_line_registry.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Stores the Maxwellian that the velocities miss most, of those seen so far.
class worst_maxwellian {
 public:
  explicit worst_maxwellian(const velocity_support& support) : support_(support) {}

  void see(const fluid_state& state, double t) {
    if (!state.admissible()) {
      if (!refused_) refused_ = {state, t};
      return;
    }
    const velocity_fit fit = support_.fit(state);
    if (!(fit.missed > fit_.missed)) return;
    fit_ = fit;
    state_ = state;
    t_ = t;
  }
  void see_moments(const double* omega, double t) { see(support_.molecules().state(omega), t); }

  /// Returns the warning about the gas of the table `path`, if there is one. Throws input_error if the
  /// velocities miss too much.
  std::optional<std::string> judge(const case_config& config, const std::string& path) const {
    if (!(fit_.missed > velocity_limits::good)) return std::nullopt;
    if (refused_ && fit_.missed > velocity_limits::bad) refuse_state(config, path);
    const velocity_words words = words_of(config, fmt::format("the gas of [{}] at t = {:.4g}", path, t_));
    std::string problem = velocity_problem(support_.molecules(), state_, fit_, words).problem;
    if (fit_.missed > velocity_limits::bad) throw input_error(place_of_emitter(config, path), problem);
    return problem;
  }

 private:
  struct state_in_time {
    fluid_state state;
    double t;
  };

  /// Throws for a temperature that reaches 0. Shortly before, it is too low for any velocities, so the
  /// temperature is the problem.
  [[noreturn]] void refuse_state(const case_config& config, const std::string& path) const {
    const auto& [state, t] = *refused_;
    throw input_error(
        place_of_emitter(config, path),
        fmt::format("[{}] has no Maxwellian at t = {:.4g} ({} {:.4g} is not positive); change its values",
                    path, t, state.rho > 0.0 ? "temperature" : "density",
                    state.rho > 0.0 ? state.T : state.rho));
  }

  const velocity_support& support_;
  velocity_fit fit_;
  fluid_state state_;
  double t_ = 0.0;
  std::optional<state_in_time> refused_;  ///< first state without a Maxwellian
};

/// Returns the times at which formulas are sampled.
std::vector<double> times_of(const case_config& config, bool steady, int intervals) {
  std::vector<double> times = {0.0};
  for (int n = 1; n <= intervals && !steady; ++n) times.push_back(config.time.end * n / intervals);
  return times;
}

class emitter_check {
 public:
  emitter_check(const case_config& config, const model& equation, const velocity_support& support)
      : config_(config), equation_(equation), support_(support) {}

  void surface(const emitter& of) {
    const emitted_values values(config_, equation_, of);
    if (!values.any()) return;
    const int intervals = values.by_functions() ? 20 : 200;
    worst_maxwellian worst(support_);
    for (const double t : times_of(config_, values.steady(), intervals))
      for (const position& x : of.points) worst.see(values.state(support_.molecules(), t, x), t);
    note(worst, of.path);
  }

  void source() {
    const auto rate = make_source(config_, equation_);
    if (!rate) return;
    constexpr int intervals = 50, most_cells = 64;
    const grid mesh = make_mesh(config_);
    const int stride = std::max(1, mesh.size() / most_cells);
    std::vector<double> row(static_cast<std::size_t>(equation_.components()));
    std::array<double, 5> omega{};
    worst_maxwellian worst(support_);
    for (const double t : times_of(config_, rate->steady, intervals))
      for (int cell = 0; cell < mesh.size(); cell += stride) try {
          rate->value(t, mesh.centre(cell), {}, row);
          support_.molecules().moments(row.data(), 0, 1, omega.data());
          worst.see_moments(omega.data(), t);
        } catch (const numerical_error&) {
          continue;  // the step that encounters it reports it
        }
    note(worst, "source");
  }

  std::vector<std::string> warnings;

 private:
  void note(const worst_maxwellian& worst, const std::string& path) {
    if (const auto warning = worst.judge(config_, path)) warnings.push_back(*warning);
  }

  const case_config& config_;
  const model& equation_;
  const velocity_support& support_;
};

}  // namespace

velocity_words words_of(const case_config& config, const std::string& subject) {
  const auto& sets = config.velocity.set;
  return {.subject = subject,
          .scales = config.scales ? &*config.scales : nullptr,
          .from_file = std::any_of(sets.begin(), sets.end(), is_velocity_file)};
}

std::vector<std::string> check_emitted_gas(const case_config& config, const model& equation) {
  const auto support = support_of(equation);
  if (!support || equation.space_dimensions() == 0) return {};
  emitter_check check(config, equation, *support);
  for (const emitter& one : emitters_of(config)) check.surface(one);
  check.source();
  return check.warnings;
}

}  // namespace apsis
