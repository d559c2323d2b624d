#include "internal/integrator_handle.hpp"

#include <apsis/c/internal/evolution_status.hpp>
#include <apsis/c/internal/guarded.hpp>
#include <apsis/c/internal/method_handle.hpp>
#include <apsis/core/errors.hpp>

#include <cmath>

#include <fmt/format.h>

namespace apsis::sundials {
namespace {

constexpr const char* handle = "the integrator";

void require_free(bool free) {
  if (!free)
    throw input_error(
        "the integrator is in use (a callback or another thread called it during apsis_sundials_evolve()); "
        "call it "
        "after the integration, or use another integrator");
}

/// Marks an integrator as busy during an integration.
class in_use {
 public:
  explicit in_use(apsis_sundials* integrator) : held_(c::require(integrator, handle)) {
    require_free(!held_.busy.exchange(true));
  }
  ~in_use() { held_.busy = false; }
  in_use(const in_use&) = delete;
  in_use& operator=(const in_use&) = delete;
  apsis_sundials& operator*() const { return held_; }

 private:
  apsis_sundials& held_;
};

/// Throws input_error unless a vector has the operations that integrations and sums call.
void require_operations(N_Vector y) {
  const auto& has = *c::require(y, "the initial state").ops;
  const std::pair<const char*, bool> operations[] = {{"nvclone", has.nvclone != nullptr},
                                                     {"nvdestroy", has.nvdestroy != nullptr},
                                                     {"nvgetlength", has.nvgetlength != nullptr},
                                                     {"nvlinearsum", has.nvlinearsum != nullptr},
                                                     {"nvconst", has.nvconst != nullptr},
                                                     {"nvprod", has.nvprod != nullptr},
                                                     {"nvscale", has.nvscale != nullptr},
                                                     {"nvabs", has.nvabs != nullptr},
                                                     {"nvinv", has.nvinv != nullptr},
                                                     {"nvaddconst", has.nvaddconst != nullptr},
                                                     {"nvdotprod", has.nvdotprod != nullptr},
                                                     {"nvmaxnorm", has.nvmaxnorm != nullptr},
                                                     {"nvl1norm", has.nvl1norm != nullptr}};
  for (const auto& [name, there] : operations) require_operation(name, there, "integrations call it");
}

void require_finite_start(double t, N_Vector y) {
  if (!std::isfinite(t))
    throw input_error("the initial time is not finite (steps begin there); give a number");
  if (!is_finite(y))
    throw input_error("the initial state is not finite (it has NaN or infinity); give numbers");
}

/// Calls the observer of the program. Returns whether the integration continues.
bool observe(apsis_sundials& s, long long step, double t, double dt, const nvector& u) {
  if (s.of.observer == nullptr) return true;
  const int returned = s.of.observing.during([&] { return s.of.observer(step, t, dt, u.get(), s.of.data); });
  if (returned < 0) c::require_success("observer", returned);
  return returned == 0;
}

/// Integrates to t1, or for one step if `once`.
int advance(apsis_sundials& s, double t1, bool once) {
  if (!std::isfinite(t1) || t1 < apsis_sundials_time(&s))
    throw input_error(fmt::format(
        "the end of the integration is {} (the time reached is {}); give a finite time that is not before it",
        t1, apsis_sundials_time(&s)));
  const sums_without_allocation sums({s.work[0].get(), s.work[1].get(), s.work[2].get()});
  if (!s.running) s.running = make_run(s);
  try {
    bool stopped = false;
    const auto end = s.running->solution.advance(t1, [&](long step, double t, double dt, const nvector& u) {
      stopped = !observe(s, s.steps + step, t, dt, u);
      return !stopped && !once;
    });
    return end == evolution_end::stopped && !stopped ? APSIS_OK : c::status_of(end);
  } catch (const numerical_error& failure) {
    throw failure.at(static_cast<long>(s.steps) + s.running->solution.steps() + 1, s.running->solution.t());
  } catch (const c::callback_error& failure) {
    throw c::callback_error(fmt::format("{} [step {}, t = {:.10g}]", failure.what(),
                                        s.steps + s.running->solution.steps() + 1, s.running->solution.t()));
  }
}

/// Calls advance() for an integrator that is not in use. Copies its time and state, also after an error.
int integrate(apsis_sundials* integrator, double t1, N_Vector y, double* reached, bool once) {
  const in_use kept(integrator);
  apsis_sundials& s = *kept;
  if (y != nullptr) require_length(s, y);
  const auto copy_out = [&] {
    if (reached != nullptr) *reached = apsis_sundials_time(&s);
    if (y != nullptr) N_VScale(1.0, (s.running ? s.running->solution.u() : s.u).get(), y);
  };
  try {
    const int status = advance(s, t1, once);
    copy_out();
    return status;
  } catch (...) {
    copy_out();
    throw;
  }
}

/// Writes dense output. Without a step of the present settings, only the state at the time reached is known.
int write_state(apsis_sundials& s, double t, N_Vector out) {
  require_length(s, out);
  if (!s.running && t != s.t)
    throw input_error(
        fmt::format("the time {:.10g} is not in the last step (none has the present settings); give the time "
                    "reached, {:.10g}",
                    t, s.t));
  const sums_without_allocation sums({s.work[0].get(), s.work[1].get(), s.work[2].get()});
  const nvector u = s.running ? s.running->solution.at(t) : s.u;
  N_VScale(1.0, u.get(), out);
  return APSIS_OK;
}

}  // namespace

apsis_sundials& idle(apsis_sundials* integrator) {
  apsis_sundials& s = c::require(integrator, handle);
  require_free(!s.busy);
  return s;
}

void require_length(const apsis_sundials& s, N_Vector y) {
  const sunindextype found = N_VGetLength(y), needed = N_VGetLength(s.u.get());
  if (found != needed)
    throw input_error(fmt::format(
        "a vector has {} elements (the state has {}); give a clone of the initial state", found, needed));
}

void end_run(apsis_sundials& s) {
  if (!s.running) return;
  const auto& solution = s.running->solution;
  s.t = solution.t();
  s.u = solution.u();
  s.steps += solution.steps();
  s.rejected += solution.rejected();
  s.found.insert(s.found.end(), solution.found().begin(), solution.found().end());
  s.running.reset();
}

}  // namespace apsis::sundials

using namespace apsis::sundials;
using apsis::c::guarded;
using apsis::c::require;

int apsis_sundials_create(const apsis_method* method, apsis_sundials_rate_function* transport,
                          apsis_sundials_rate_function* collision, sunrealtype t0, N_Vector y0,
                          SUNContext context, apsis_sundials** created) {
  return guarded([=] {
    require(created, "the place of the integrator") = nullptr;
    const auto& m = *require(method, "the method").integrator;
    require(context, "the context");
    require_operations(y0);
    require_finite_start(t0, y0);
    if (m.needs.exact_collision)
      throw apsis::input_error(
          "method '" + m.name +
          "' solves u' = Q(u) exactly (which N_Vectors are not solved for); choose another method");
    auto made = std::make_unique<apsis_sundials>();
    made->method = &m;
    made->t = t0;
    made->u = nvector(y0);
    for (nvector& one : made->work) one = made->u.another();
    made->of.transport = transport;
    made->of.collision = collision;
    made->of.context = context;
    *created = made.release();
    return APSIS_OK;
  });
}

void apsis_sundials_free(apsis_sundials* integrator) {
  delete integrator;
}

int apsis_sundials_reset(apsis_sundials* integrator, sunrealtype t, N_Vector y) {
  return guarded([=] {
    apsis_sundials& s = idle(integrator);
    require(y, "the initial state");
    require_length(s, y);
    require_finite_start(t, y);
    nvector u(y);
    s.running.reset();
    s.t = t;
    s.u.swap(u);
    s.steps = s.rejected = s.steps_before_reset = 0;
    s.found.clear();
    s.of.counts.fill(0);
    return APSIS_OK;
  });
}

int apsis_sundials_evolve(apsis_sundials* integrator, sunrealtype tout, N_Vector y, sunrealtype* treached) {
  return guarded([=] { return integrate(integrator, tout, y, treached, false); });
}

int apsis_sundials_one_step(apsis_sundials* integrator, sunrealtype tout, N_Vector y, sunrealtype* treached) {
  return guarded([=] { return integrate(integrator, tout, y, treached, true); });
}

int apsis_sundials_state_at(apsis_sundials* integrator, sunrealtype t, N_Vector y) {
  return guarded([=] {
    require(y, "the place of the state");
    // The observer runs between two steps. Callbacks of this dense output must not ask for more.
    if (auto& observing = require(integrator, handle).of.observing; observing.is_this_one())
      return observing.pausing([=] { return write_state(*integrator, t, y); });
    const in_use kept(integrator);
    return write_state(*kept, t, y);
  });
}

int apsis_sundials_found_event(const apsis_sundials* integrator, size_t index, size_t* k, sunrealtype* t) {
  return guarded([=] {
    const apsis_sundials& s = require(integrator, handle);
    const std::size_t earlier = s.found.size();
    const std::size_t all = earlier + (s.running ? s.running->solution.found().size() : 0);
    if (index >= all)
      throw apsis::input_error(
          fmt::format("there is no event {} (their number is {}); see APSIS_SUNDIALS_EVENTS", index, all));
    const auto& one = index < earlier ? s.found[index] : s.running->solution.found()[index - earlier];
    require(k, "the place of the function") = one.function;
    require(t, "the place of the time") = one.t;
    return APSIS_OK;
  });
}

sunrealtype apsis_sundials_time(const apsis_sundials* integrator) {
  if (integrator == nullptr) return std::numeric_limits<double>::quiet_NaN();
  return integrator->running ? integrator->running->solution.t() : integrator->t;
}

long long apsis_sundials_count(const apsis_sundials* integrator, int counter) {
  if (integrator == nullptr || counter < 0 || counter > APSIS_SUNDIALS_EVENTS) return -1;
  const auto* run = integrator->running.get();
  if (counter == APSIS_SUNDIALS_STEPS)
    return integrator->steps + (run != nullptr ? run->solution.steps() : 0);
  if (counter == APSIS_SUNDIALS_REJECTED_STEPS)
    return integrator->rejected + (run != nullptr ? run->solution.rejected() : 0);
  const std::size_t events = integrator->found.size() + (run != nullptr ? run->solution.found().size() : 0);
  if (counter == APSIS_SUNDIALS_EVENTS) return static_cast<long long>(events);
  return integrator->of.counts[static_cast<std::size_t>(counter)];
}

N_Vector apsis_sundials_clone(N_Vector y) {
  N_Vector made = nullptr;
  guarded([&] {
    require_operations(y);
    made = N_VClone(y);
    if (made == nullptr) throw std::bad_alloc();
    use_equal_sums(made);
    N_VScale(1.0, y, made);
    return APSIS_OK;
  });
  return made;
}
