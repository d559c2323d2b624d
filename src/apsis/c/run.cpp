#include "internal/evolution_status.hpp"
#include "internal/integrator_handle.hpp"
#include "internal/newton_blocks.hpp"
#include "internal/split_problem.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/evolution.hpp>

#include <cmath>
#include <string>
#include <type_traits>

#include <fmt/format.h>

namespace apsis::c {
namespace {

/// Returns max_i |u_i − v_i|/(absolute_i + relative |u_i|), NaN if a quotient is NaN.
double weighted_difference(const step_limits& limits, const numbers& u, const numbers& v) {
  double largest = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double one = std::abs(u[i] - v[i]) / (limits.absolute[i] + limits.relative * std::abs(u[i]));
    if (std::isnan(one)) return one;
    if (one > largest) largest = one;
  }
  return largest;
}

/// Returns the event functions of a program.
event_functions<numbers, double> functions_of(callbacks& of, const event_settings& events) {
  return {events.count,
          [&of](double t, const numbers& u, std::span<double> g) {
            require_success("events", of.events(t, u.size(), u.data(), g.size(), g.data(), of.data));
          },
          events.directions, std::vector<bool>(events.ends.begin(), events.ends.end())};
}

template <class Problem>
class run_of final : public any_run {
 public:
  run_of(const time_integrator& m, callbacks& of, const step_rule<double>& rule, const step_limits& limits,
         const std::optional<step_tolerance<numbers, double>>& tolerance, const event_settings& events,
         double t, const numbers& u)
      : problem_(of), evolution_(m, problem_, rule, tolerance) {
    if constexpr (std::is_same_v<Problem, newton_blocks>) {
      if (tolerance) problem_.set_tolerances(limits.relative, limits.absolute, u.size());
    }
    evolution_.set_stops(events.stops);
    evolution_.set_events(functions_of(of, events), [&of](std::size_t k, double at, const numbers& now) {
      if (of.event_observer == nullptr) return;
      require_success("event_observer", of.observing.during([&] {
        return of.event_observer(k, at, now.size(), now.data(), of.data);
      }));
    });
    evolution_.start(t, u);
  }

  int advance(double t1, const observer& observe) override {
    return status_of(evolution_.advance(t1, observe));
  }
  numbers at(double t) override { return evolution_.at(t); }
  const std::vector<found_event<double>>& found() const override { return evolution_.found(); }
  double t() const override { return evolution_.t(); }
  const numbers& u() const override { return evolution_.u(); }
  long steps() const override { return evolution_.steps(); }
  long rejected() const override { return evolution_.rejected(); }

 private:
  Problem problem_;
  evolution<Problem> evolution_;
};

bool has_collision(const callbacks& of) {
  return of.stage != nullptr || of.has_rate() || of.flow != nullptr;
}

/// Whether a method solves no stages.
bool is_explicit(const time_integrator& m) {
  return m.file() != nullptr && m.file()->kind == method_kind::explicit_only;
}

/// Whether Newton's method solves the stages, or a mass matrix divides the rates of an explicit method.
bool is_newton(const time_integrator& m, const callbacks& of) {
  if (m.needs.exact_collision) return false;
  const bool by_differences = of.is_differenced() && of.stage == nullptr && !is_explicit(m);
  return of.has_derivatives() || of.mass || by_differences;
}

/// Throws input_error if functions of Q(u) and of Q(t, u) are mixed.
void require_one_time(const callbacks& of) {
  if (of.rate != nullptr && of.timed_rate != nullptr)
    throw input_error("Q(u) and Q(t, u) are given (there is one Q); remove one of them");
  if (of.timed_rate != nullptr &&
      (of.jacobian != nullptr || of.product != nullptr || of.curvature != nullptr))
    throw input_error(
        "derivatives of Q(u) are given for Q(t, u) (they do not receive t); give apsis_set_timed_product(), "
        "or "
        "remove them");
  if (of.timed_product != nullptr && of.timed_rate == nullptr)
    throw input_error(
        "derivatives of Q(t, u) are given without Q(t, u) (stages need both); give it by "
        "apsis_set_timed_rate()");
}

/// Throws input_error unless pattern, preconditioner and mass matrix are those of a block, and Newton's
/// method uses them.
void require_matrices(const time_integrator& m, const callbacks& of) {
  const auto require_size = [&](const char* what, std::size_t n) {
    if (n != of.block_size)
      throw input_error(
          fmt::format("{} of {} unknowns is given and a block has {} (the block size was changed); give it "
                      "again, after apsis_set_block_size()",
                      what, n, of.block_size));
  };
  if (of.precondition != nullptr && of.stage != nullptr)
    throw input_error(
        "a preconditioner and a stage solver are given (it is part of Newton's method); remove one of them");
  if (of.precondition != nullptr && of.pattern)
    throw input_error(
        "a preconditioner and a sparsity pattern are given (sparse systems are factorized, without "
        "iterations); remove one of them");
  if (of.pattern) require_size("a sparsity pattern", of.pattern->size());
  if (!of.mass) return;
  require_size("a mass matrix", of.mass->size());
  if (of.stage != nullptr || of.flow != nullptr)
    throw input_error(
        "a mass matrix is given with a stage solver or a flow (they solve u' = Q(u)); remove one, or give a "
        "rate and its derivatives");
  if (m.needs.exact_collision)
    throw input_error("method '" + m.name +
                      "' solves u' = Q(u) exactly (and a mass matrix is given); choose another method");
}

/// Throws input_error unless the collision is given in the form that the method needs.
void require_collision(const time_integrator& m, const callbacks& of) {
  if (of.stage != nullptr && of.has_derivatives())
    throw input_error(
        "a stage solver and derivatives of Q are given (only one of them can solve the stages); remove one");
  if (of.has_derivatives() && !of.has_rate())
    throw input_error("derivatives of Q are given without Q (stages need both); give it by apsis_set_rate()");
  require_one_time(of);
  require_matrices(m, of);
  if (!has_collision(of)) return;
  if (m.needs.exact_collision && of.flow == nullptr)
    throw input_error("method '" + m.name +
                      "' solves u' = Q(u) exactly (and there is no flow); give it by apsis_set_flow(), or "
                      "choose another method");
  if (m.needs.explicit_collision && !of.has_rate())
    throw input_error("method '" + m.name +
                      "' evaluates Q (and there is no rate); give it by apsis_set_rate(), or choose another "
                      "method");
  if (!m.needs.exact_collision && !is_explicit(m) && of.stage == nullptr && !of.has_rate())
    throw input_error("method '" + m.name +
                      "' solves stages (and there is neither a stage solver nor a rate); give one by "
                      "apsis_set_stage() or apsis_set_rate()");
}

/// Returns the limit of the steps. Throws input_error unless there is one.
step_rule<double> rule_of(const callbacks& of, const step_limits& limits, bool fresh) {
  const bool limited = of.forward_euler_step != nullptr;
  if (limits.dt && limited)
    throw input_error(
        "dt and a forward Euler step are given (each sets the length of steps); remove one of them");
  if (!limits.dt && !limited && limits.absolute.empty())
    throw input_error(
        "the step size is unknown (neither dt nor a tolerance nor a forward Euler step is given); give one "
        "by "
        "apsis_set_step(), apsis_set_tolerance() or apsis_set_forward_euler_step()");
  if (limits.growth > 0 && of.relaxation_time == nullptr)
    throw input_error(
        "a graded start needs the width of the initial layer (there is no relaxation time); give it by "
        "apsis_set_relaxation_time()");
  if (limits.first_step && limits.absolute.empty())
    throw input_error(
        "a first step is given without a tolerance (the steps have the same length or follow Δt_FE); give a "
        "tolerance by apsis_set_tolerance(), or remove the first step");
  if (limits.first_step && limits.growth > 0)
    throw input_error(
        "a first step and a graded start are given (each determines the first step); remove one of them");
  const auto rule = limits.dt ? step_rule<double>::fixed(*limits.dt)
                    : limited ? step_rule<double>::ssp(limits.safety)
                              : step_rule<double>::unlimited();
  return limits.growth > 0 && fresh ? rule.with(startup::graded, limits.growth) : rule;
}

}  // namespace

std::unique_ptr<any_run> make_run(const time_integrator& m, callbacks& of, const step_limits& limits,
                                  const event_settings& events, double t, const numbers& u, bool fresh) {
  require_collision(m, of);
  const auto rule = rule_of(of, limits, fresh);
  std::optional<step_tolerance<numbers, double>> tolerance;
  if (!limits.absolute.empty())
    tolerance = {1.0,
                 [limits](const numbers& a, const numbers& b) { return weighted_difference(limits, a, b); },
                 fresh ? limits.first_step : std::nullopt, limits.controller};
  const bool by_newton = is_newton(m, of);
  if (by_newton && of.relaxation_time != nullptr)
    throw input_error(
        "a relaxation time is given and Newton's method solves the stages (it belongs to a stage solver); "
        "remove "
        "it, or give a stage solver by apsis_set_stage()");
  if (by_newton) return std::make_unique<run_of<newton_blocks>>(m, of, rule, limits, tolerance, events, t, u);
  return std::make_unique<run_of<split_problem>>(m, of, rule, limits, tolerance, events, t, u);
}

}  // namespace apsis::c
