#include "internal/ts_apsis.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/time_integrator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <petsc/private/snesimpl.h>

namespace apsis::petsc {
namespace {

bool has_type(PetscObject object, const char* type) {
  PetscBool same = PETSC_FALSE;
  check(PetscObjectTypeCompare(object, type, &same));
  return same == PETSC_TRUE;
}

SNESLineSearch line_search_of(TS ts) {
  SNES snes = nullptr;
  SNESLineSearch search = nullptr;
  check(TSGetSNES(ts, &snes));
  check(SNESGetLineSearch(snes, &search));
  return search;
}

bool is_finite(Vec u) {
  PetscReal size = 0.0;
  check(VecNorm(u, NORM_INFINITY, &size));
  return std::isfinite(size);
}

}  // namespace

ts_apsis::ts_apsis(TS ts)
    : ts_(ts), functions_(ts), stages_(functions_, settings_.stages), problem_(functions_, stages_) {
  set_method(settings_.method);
  // Residuals do not measure errors (stage_solver), so that a line search by their norm would mislead.
  // Options of the program have precedence, because PETSc reads them later.
  const SNESLineSearch search = line_search_of(ts);
  SNESLineSearchType type = nullptr;
  check(SNESLineSearchGetType(search, &type));
  if (type != nullptr && std::string_view(type) != SNESLINESEARCHBT) return;
  check(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  set_line_search_ = true;
}

ts_apsis::~ts_apsis() {
  const SNESLineSearch search = ts_->snes != nullptr ? ts_->snes->linesearch : nullptr;
  if (!set_line_search_ || search == nullptr) return;
  SNESLineSearchType type = nullptr;
  static_cast<void>(SNESLineSearchGetType(search, &type));
  if (type != nullptr && std::string_view(type) == SNESLINESEARCHBASIC)
    static_cast<void>(SNESLineSearchSetType(search, SNESLINESEARCHBT));
}

void ts_apsis::set_method(const std::string& name) {
  const time_integrator& found = find_integrator(name);
  const method* one = found.one_step();
  if (one == nullptr || one->kind == method_kind::exact_collision)
    throw input_error(fmt::format(
        "method '{}' is no method for the TS type 'apsis' ({}); choose a method of one step with implicit or "
        "explicit stages, such as 'md-imex-8-3-mixed'",
        name,
        one != nullptr ? "it solves collisions exactly"
                       : fmt::format("it needs {} equal steps, which PETSc does not promise", found.steps)));
  settings_.method = one->name;
  method_ = one;
  forget();
}

void ts_apsis::set_up() {
  other_ = nullptr;
}

void ts_apsis::reset() {
  forget();
  stages_.reset();
  functions_.reset();
  problem_.reset();
  other_ = nullptr;
  for (vector* one : {&start_, &now_, &inside_}) one->reset();
}

bool ts_apsis::wants_estimate() const {
  const auto adapt = reinterpret_cast<PetscObject>(ts_->adapt);
  return !has_type(adapt, TSADAPTNONE) && !has_type(adapt, TSADAPTCFL) && !has_type(adapt, TSADAPTHISTORY);
}

/// Makes the stepper, unless there is one for the present settings.
void ts_apsis::prepare() {
  const bool estimate = wants_estimate();
  if (stepper_ && estimate == estimates_) return;
  functions_.set_fully_implicit(settings_.fully_implicit || method_->kind == method_kind::implicit_only);
  functions_.require_form(ts_->ptime, ts_->vec_sol);
  stages_.detach();
  stepper_.emplace(*method_, problem_, estimate ? solutions::result_and_embedded : solutions::result);
  estimates_ = estimate;
  if (settings_.forward_euler_step && !(*settings_.forward_euler_step > 0.0))
    throw input_error(fmt::format("-ts_apsis_ssp_step is {:g} (it is not positive); give a positive time",
                                  *settings_.forward_euler_step));
  if (settings_.forward_euler != nullptr || settings_.forward_euler_step) stepper_->require_ssp_coefficient();
}

/// Returns the step length min(dt, r Δt_FE).
double ts_apsis::limited(double dt) {
  double longest = settings_.forward_euler_step.value_or(std::numeric_limits<double>::infinity());
  if (settings_.forward_euler != nullptr) {
    PetscReal of_program = 0.0;
    check(
        settings_.forward_euler(ts_, ts_->ptime, ts_->vec_sol, &of_program, settings_.forward_euler_context));
    if (!(of_program > 0.0))
      throw input_error(fmt::format(
          "the forward Euler step of the program is {:g} (it is not positive); return a positive time",
          of_program));
    longest = std::min(longest, of_program);
  }
  return std::min(dt, stepper_->r() * longest);
}

/// Computes the result of a step and, if errors are estimated, the second solution.
void ts_apsis::advance(double t, double dt, vector& u) {
  other_ = nullptr;
  if (!estimates_) return stepper_->step(t, dt, u);
  const auto tried = stepper_->attempt(t, dt, u);
  check(VecCopy(tried.result.get(), now_.like(u.get())));
  other_ = &tried.embedded;
}

/// Advances the solution of the TS; returns false if the step must be repeated with another length.
bool ts_apsis::try_step() {
  try {
    problem_.begin_step(ts_->time_step, true);
    if (!estimates_) now_ = start_;
    advance(ts_->ptime, ts_->time_step, estimates_ ? start_ : now_);
    if (!is_finite(now_.get()))
      throw numerical_error(
          "the result of a step is not finite (it is unstable, or a function is); reduce it");
    // Stages were checked by TSAdaptCheckStage(), results of explicit methods were not.
    PetscBool accepted = PETSC_TRUE;
    check(TSFunctionDomainError(ts_, ts_->ptime + ts_->time_step, now_.get(), &accepted));
    if (accepted == PETSC_FALSE)
      throw numerical_error(
          "the result of a step is outside the domain (TSSetFunctionDomainError()); reduce it");
    check(VecCopy(now_.get(), ts_->vec_sol));
    return true;
  } catch (const rejected_stage&) {
    return false;
  } catch (const numerical_error&) {
    ts_->time_step *= ts_->adapt->scale_solve_failed;
    return false;
  }
}

void ts_apsis::step() {
  prepare();
  if (ts_->steps == 0) stages_.reset_counter();  // as TSSolve() resets the counters of iterations
  start_.assign(ts_->vec_sol);
  PetscInt rejections = 0;
  while (ts_->reason == TS_CONVERGED_ITERATING) {
    const double wanted = ts_->time_step;
    ts_->time_step = limited(wanted);
    if (try_step() && choose_next(wanted)) return;
    check(VecCopy(start_.get(), ts_->vec_sol));
    ++ts_->reject;
    if (ts_->reason == TS_CONVERGED_ITERATING && ++rejections > ts_->max_reject && ts_->max_reject >= 0)
      ts_->reason = TS_DIVERGED_STEP_REJECTED;
  }
}

/// Accepts the step and sets the length of the next one, or sets the length for another try.
bool ts_apsis::choose_next(double wanted) {
  const double dt = ts_->time_step;
  PetscBool accepted = PETSC_FALSE;
  PetscReal next = dt;
  check(TSAdaptCandidatesClear(ts_->adapt));
  check(TSAdaptCandidateAdd(ts_->adapt, method_->name.c_str(), method_->claims.order, 1, stepper_->r(),
                            static_cast<PetscReal>(method_->stages()), PETSC_TRUE));
  check(TSAdaptChoose(ts_->adapt, ts_, dt, nullptr, &next, &accepted));
  if (accepted == PETSC_FALSE) {
    ts_->time_step = next;
    return false;
  }
  ts_->ptime += dt;
  // Without a controller, the step returns to the length that the program chose when Δt_FE allows it.
  if (next == dt && dt < wanted && ts_->tspan == nullptr && !wants_estimate()) {
    next = wanted;
    const double left = ts_->max_time - ts_->ptime;
    if (ts_->exact_final_time == TS_EXACTFINALTIME_MATCHSTEP && left > 0.0) next = std::min(next, left);
  }
  ts_->time_step = next;
  return true;
}

void ts_apsis::roll_back() {
  check(VecCopy(start_.get(), ts_->vec_sol));
}

void ts_apsis::interpolate(double t, Vec out) {
  const double begin = ts_->ptime_prev;
  if (t == ts_->ptime) return check(VecCopy(ts_->vec_sol, out));
  inside_ = start_;
  if (t != begin) {
    problem_.begin_step(t - begin, false);
    if (estimates_) {
      // The steps use attempt(), too, so that dense output agrees with them at both ends.
      const auto tried = stepper_->attempt(begin, t - begin, inside_);
      other_ = nullptr;
      return check(VecCopy(tried.result.get(), out));
    }
    advance(begin, t - begin, inside_);
  }
  check(VecCopy(inside_.get(), out));
}

void ts_apsis::evaluate_step(PetscInt order, Vec out, PetscBool* done) {
  const bool of_result = order == method_->claims.order;
  const bool of_other = other_ != nullptr && order == estimate_of(*method_).order && !of_result;
  if (of_result) check(VecCopy(ts_->vec_sol, out));
  if (of_other) check(VecCopy(other_->get(), out));
  if (done != nullptr) {
    *done = of_result || of_other ? PETSC_TRUE : PETSC_FALSE;
  } else if (!of_result && !of_other) {
    throw input_error(
        fmt::format("method '{}' has no solution of order {} (its order is {}); ask for another",
                    method_->name, order, method_->claims.order));
  }
}

void ts_apsis::evaluate_error(NormType norm, PetscInt* order, PetscReal* error) {
  *order = estimate_of(*method_).order + 1;
  *error = -1.0;
  if (other_ == nullptr) return;
  PetscReal absolute = 0.0, relative = 0.0;
  check(TSErrorWeightedNorm(ts_, ts_->vec_sol, other_->get(), norm, error, &absolute, &relative));
  *error *= stepper_->weight_of_estimate();
}

}  // namespace apsis::petsc
