#include "internal/integrator_handle.hpp"

#include <apsis/c/internal/guarded.hpp>
#include <apsis/core/errors.hpp>

#include <string>

namespace apsis::sundials {
namespace {

/// Returns the events of an integrator.
event_functions<nvector, double> functions_of(apsis_sundials& s) {
  return {s.events.count,
          [&of = s.of](double t, const nvector& u, std::span<double> g) {
            c::require_success("roots", of.roots(t, u.get(), g.data(), of.data));
          },
          s.events.directions, std::vector<bool>(s.events.ends.begin(), s.events.ends.end())};
}

/// Whether a method solves no stages.
bool is_explicit(const time_integrator& m) {
  return m.file() != nullptr && m.file()->kind == method_kind::explicit_only;
}

/// Throws input_error unless the functions of a program fit each other and the method.
void require_functions(const time_integrator& m, const functions& of) {
  if (of.stage != nullptr &&
      (of.product != nullptr || of.jacobian != nullptr || of.preconditioner != nullptr))
    throw input_error(
        "a stage solver and parts of Newton's method are given (only one of them can solve the stages); "
        "remove one");
  if (of.matrix != nullptr && of.jacobian == nullptr)
    throw input_error(
        "the linear solver has a matrix (and there is no Jacobian); give it by "
        "apsis_sundials_set_jacobian(), or "
        "choose an iterative solver");
  if (of.jacobian != nullptr && of.matrix == nullptr)
    throw input_error(
        "a Jacobian is given (and there is no matrix for it); give one with a direct solver by "
        "apsis_sundials_set_linear_solver()");
  if (of.matrix != nullptr && of.preconditioner != nullptr)
    throw input_error(
        "a direct solver and a preconditioner are given (the solver preconditions already); remove one");
  if (of.collision == nullptr && of.stage != nullptr && m.needs.explicit_collision)
    throw input_error(
        "method '" + m.name +
        "' evaluates Q (and there is no collision); give it to apsis_sundials_create(), or choose "
        "another method");
  if (of.collision != nullptr && of.stage != nullptr && is_explicit(m))
    throw input_error(
        "method '" + m.name +
        "' solves no stages (and a stage solver is given); remove it, or choose another method");
  if (of.relaxation_time != nullptr && of.stage == nullptr)
    throw input_error(
        "a relaxation time is given and Newton's method solves the stages (it belongs to a stage solver); "
        "remove it, "
        "or give a stage solver by apsis_sundials_set_stage()");
}

/// Returns the limit of the steps. Throws input_error unless there is one.
step_rule<double> rule_of(const apsis_sundials& s) {
  const bool limited = s.of.forward_euler_step != nullptr;
  if (s.limits.dt && limited)
    throw input_error(
        "dt and a forward Euler step are given (each sets the length of steps); remove one of them");
  if (!s.limits.dt && !limited && !s.accuracy.absolute)
    throw input_error(
        "the step size is unknown (neither dt nor a tolerance nor a forward Euler step is given); give one "
        "by "
        "apsis_sundials_set_step(), apsis_sundials_set_tolerance() or "
        "apsis_sundials_set_forward_euler_step()");
  if (s.limits.growth > 0 && s.of.relaxation_time == nullptr)
    throw input_error(
        "a graded start needs the width of the initial layer (there is no relaxation time); give it by "
        "apsis_sundials_set_relaxation_time()");
  const auto rule = s.limits.dt ? step_rule<double>::fixed(*s.limits.dt)
                    : limited   ? step_rule<double>::ssp(s.limits.safety)
                                : step_rule<double>::unlimited();
  return s.limits.growth > 0 && s.steps == 0 ? rule.with(startup::graded, s.limits.growth) : rule;
}

/// Returns the control of errors in the norm of ARKODE; none without a tolerance.
std::optional<step_tolerance<nvector, double>> tolerance_of(const apsis_sundials& s) {
  if (!s.accuracy.absolute) return std::nullopt;
  auto weights = std::make_shared<nvector>(s.u.another()),
       difference = std::make_shared<nvector>(s.u.another());
  step_tolerance<nvector, double> made{
      1.0, [&accuracy = s.accuracy, weights, difference](const nvector& u, const nvector& v) {
        set_weights(accuracy.relative, accuracy.absolute.get(), u.get(), weights->get());
        N_VLinearSum(1.0, u.get(), -1.0, v.get(), difference->get());
        return N_VWrmsNorm(difference->get(), weights->get());
      }};
  if (s.steps == 0) made.first_step = s.limits.first_step;
  made.controller = s.limits.controller;
  return made;
}

}  // namespace

run::run(apsis_sundials& s, const step_rule<double>& rule)
    : problem(s.of, s.accuracy, s.u), solution(*s.method, problem, rule, tolerance_of(s)) {
  solution.set_stops(s.events.stops);
  solution.set_events(functions_of(s));
  solution.start(s.t, s.u);
}

std::unique_ptr<run> make_run(apsis_sundials& s) {
  require_functions(*s.method, s.of);
  return std::make_unique<run>(s, rule_of(s));
}

}  // namespace apsis::sundials
