#include "internal/guarded.hpp"
#include "internal/idle.hpp"
#include "internal/integrator_handle.hpp"
#include "internal/method_handle.hpp"

#include <apsis/apsis.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>

#include <fmt/format.h>

namespace apsis::c {

void require_free(bool free) {
  if (!free)
    throw input_error(
        "the integrator is in use (a callback or another thread called it during apsis_integrate()); call it "
        "after the integration, or use another integrator");
}

apsis_integrator& idle(apsis_integrator* integrator) {
  apsis_integrator& s = require(integrator, handle);
  require_free(!s.busy);
  return s;
}

namespace {

/// Marks an integrator as busy during an integration.
class in_use {
 public:
  explicit in_use(apsis_integrator* integrator) : held_(require(integrator, handle)) {
    require_free(!held_.busy.exchange(true));
  }
  ~in_use() { held_.busy = false; }
  in_use(const in_use&) = delete;
  in_use& operator=(const in_use&) = delete;
  apsis_integrator& operator*() const { return held_; }

 private:
  apsis_integrator& held_;
};

void require_finite_state(std::span<const double> u) {
  for (std::size_t i = 0; i < u.size(); ++i)
    if (!std::isfinite(u[i]))
      throw input_error(
          fmt::format("the initial state is not finite (component {} is {}); give numbers", i, u[i]));
}

/// Calls the observer of the program. Returns whether the integration continues.
bool observe(apsis_integrator& s, long long step, double t, double dt, const numbers& u) {
  if (s.of.observer == nullptr) return true;
  const int returned =
      s.of.observing.during([&] { return s.of.observer(step, t, dt, u.size(), u.data(), s.of.data); });
  if (returned < 0) require_success("observer", returned);
  return returned == 0;
}

void require_started(const apsis_integrator& s) {
  if (!s.started)
    throw input_error("the integrator has no initial state (apsis_start() was not called); call it first");
}

int integrate(apsis_integrator& s, double t1) {
  require_started(s);
  if (!std::isfinite(t1) || t1 < apsis_time(&s))
    throw input_error(fmt::format(
        "the end of the integration is {} (the time reached is {}); give a finite time that is not before it",
        t1, apsis_time(&s)));
  if (!s.run) s.run = make_run(*s.method, s.of, s.limits, s.events, s.t, s.u, s.steps == 0);
  try {
    return s.run->advance(t1, [&s](long step, double t, double dt, const numbers& u) {
      return observe(s, s.steps + step, t, dt, u);
    });
  } catch (const numerical_error& failure) {
    throw failure.at(static_cast<long>(s.steps) + s.run->steps() + 1, s.run->t());
  } catch (const callback_error& failure) {
    throw callback_error(
        fmt::format("{} [step {}, t = {:.10g}]", failure.what(), s.steps + s.run->steps() + 1, s.run->t()));
  }
}

/// Writes dense output. Without a step of the present settings, only the state at the time reached is known.
int write_state(apsis_integrator& s, double t, double* out) {
  require_started(s);
  if (!s.run && t != s.t)
    throw input_error(
        fmt::format("the time {:.10g} is not in the last step (none has the present settings); give the time "
                    "reached, {:.10g}",
                    t, s.t));
  const numbers u = s.run ? s.run->at(t) : s.u;
  std::copy(u.begin(), u.end(), out);
  return APSIS_OK;
}

}  // namespace
}  // namespace apsis::c

using namespace apsis::c;

int apsis_new_integrator(const apsis_method* method, size_t n, apsis_integrator** integrator) {
  return guarded([=] {
    require(integrator, "the place of the integrator") = nullptr;
    const auto& m = require(method, "the method");
    if (n == 0) throw apsis::input_error("there are no unknowns (n = 0); give n ≥ 1");
    // A negative int becomes a number like this.
    if (n > std::numeric_limits<std::ptrdiff_t>::max() / sizeof(double))
      throw apsis::input_error(fmt::format(
          "n = {} is more than memory has addresses (n is the number of unknowns); give fewer", n));
    *integrator = new apsis_integrator{.method = m.integrator, .n = n};
    (*integrator)->of.block_size = n;
    return APSIS_OK;
  });
}

void apsis_free_integrator(apsis_integrator* integrator) {
  delete integrator;
}

int apsis_start(apsis_integrator* integrator, double t0, const double* u0) {
  return guarded([=] {
    apsis_integrator& s = idle(integrator);
    const double* given = &require(u0, "the initial state");
    if (!std::isfinite(t0))
      throw apsis::input_error("the initial time is not finite (steps begin there); give a number");
    require_finite_state({given, s.n});
    numbers u(given, given + s.n);
    s.run.reset();
    s.t = t0;
    s.u.swap(u);
    s.steps = s.rejected = 0;
    s.found.clear();
    s.of.counts.fill(0);
    s.started = true;
    return APSIS_OK;
  });
}

int apsis_integrate(apsis_integrator* integrator, double t1) {
  return guarded([=] {
    const in_use kept(integrator);
    return integrate(*kept, t1);
  });
}

int apsis_state_at(apsis_integrator* integrator, double t, double* u) {
  return guarded([=] {
    double* out = &require(u, "the place of the state");
    // The observer runs between two steps. Callbacks of this dense output must not ask for more.
    if (auto& observing = require(integrator, handle).of.observing; observing.is_this_one())
      return observing.pausing([=] { return write_state(*integrator, t, out); });
    const in_use kept(integrator);
    return write_state(*kept, t, out);
  });
}

int apsis_found_event(const apsis_integrator* integrator, size_t index, size_t* k, double* t) {
  return guarded([=] {
    const apsis_integrator& s = require(integrator, handle);
    const std::size_t earlier = s.found.size();
    const std::size_t all = earlier + (s.run ? s.run->found().size() : 0);
    if (index >= all)
      throw apsis::input_error(
          fmt::format("there is no event {} (their number is {}); see APSIS_EVENTS", index, all));
    const auto& one = index < earlier ? s.found[index] : s.run->found()[index - earlier];
    require(k, "the place of the function") = one.function;
    require(t, "the place of the time") = one.t;
    return APSIS_OK;
  });
}

double apsis_time(const apsis_integrator* integrator) {
  if (integrator == nullptr) return std::numeric_limits<double>::quiet_NaN();
  return integrator->run ? integrator->run->t() : integrator->t;
}

const double* apsis_state(const apsis_integrator* integrator) {
  if (integrator == nullptr || !integrator->started) return nullptr;
  return integrator->run ? integrator->run->u().data() : integrator->u.data();
}

long long apsis_count(const apsis_integrator* integrator, int counter) {
  if (integrator == nullptr || counter < 0 || counter > APSIS_PRECONDITIONER_SOLVES) return -1;
  const auto* run = integrator->run.get();
  if (counter == APSIS_STEPS) return integrator->steps + (run != nullptr ? run->steps() : 0);
  if (counter == APSIS_REJECTED_STEPS) return integrator->rejected + (run != nullptr ? run->rejected() : 0);
  const std::size_t events = integrator->found.size() + (run != nullptr ? run->found().size() : 0);
  if (counter == APSIS_EVENTS) return static_cast<long long>(events);
  return integrator->of.counts[static_cast<std::size_t>(counter)];
}
