#include "internal/guarded.hpp"
#include "internal/integrator_handle.hpp"
#include "internal/method_handle.hpp"

#include <apsis/apsis.h>
#include <apsis/core/graded_start.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include <fmt/format.h>

namespace apsis::c {
namespace {

constexpr const char* handle = "the integrator";

/// Throws input_error unless `free`.
void require_free(bool free) {
  if (!free)
    throw input_error(
        "the integrator is in use (a callback or another thread called it during apsis_integrate()); call it "
        "after the integration, or use another integrator");
}

/// Returns an integrator that no callback and no other thread uses. Throws input_error if one does.
apsis_integrator& idle(apsis_integrator* integrator) {
  apsis_integrator& s = require(integrator, handle);
  require_free(!s.busy);
  return s;
}

/// Keeps an integrator for the time of an integration.
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

/// Ends a run: other settings need another one.
void end_run(apsis_integrator& s) {
  if (!s.run) return;
  s.t = s.run->t();
  s.u = s.run->u();
  s.steps += s.run->steps();
  s.rejected += s.run->rejected();
  s.run.reset();
}

/// Changes settings by change(integrator).
template <class Change>
int set(apsis_integrator* integrator, const Change& change) {
  return guarded([&] {
    apsis_integrator& s = idle(integrator);
    change(s);
    end_run(s);
    return APSIS_OK;
  });
}

void require_finite_state(std::span<const double> u) {
  for (std::size_t i = 0; i < u.size(); ++i)
    if (!std::isfinite(u[i]))
      throw input_error(
          fmt::format("the initial state is not finite (component {} is {}); give numbers", i, u[i]));
}

void set_tolerances(apsis_integrator& s, double relative, numbers absolute) {
  if (!(relative >= 0.0) || !std::isfinite(relative))
    throw input_error(fmt::format(
        "the relative tolerance is {} (it is at least 0 and finite); give such a number", relative));
  for (const double one : absolute)
    if (!(one > 0.0) || !std::isfinite(one))
      throw input_error(
          fmt::format("an absolute tolerance is {} (it is above 0 and finite); give such a number", one));
  s.limits.relative = relative;
  s.limits.absolute = std::move(absolute);
}

/// Calls the observer of the program. Returns whether the integration continues.
bool observe(const apsis_integrator& s, long long step, double t, double dt, const numbers& u) {
  if (s.of.observer == nullptr) return true;
  const int returned = s.of.observer(step, t, dt, u.size(), u.data(), s.of.data);
  if (returned < 0) require_success("observer", returned);
  return returned == 0;
}

int integrate(apsis_integrator& s, double t1) {
  if (!s.started)
    throw input_error("the integrator has no initial state (apsis_start() was not called); call it first");
  if (!std::isfinite(t1) || t1 < apsis_time(&s))
    throw input_error(fmt::format(
        "the end of the integration is {} (the time reached is {}); give a finite time that is not before it",
        t1, apsis_time(&s)));
  if (!s.run) s.run = make_run(*s.method, s.of, s.limits, s.t, s.u, s.steps == 0);
  try {
    const bool reached = s.run->advance(t1, [&s](long step, double t, double dt, const numbers& u) {
      return observe(s, s.steps + step, t, dt, u);
    });
    return reached ? APSIS_OK : APSIS_STOPPED;
  } catch (const numerical_error& failure) {
    throw failure.at(static_cast<long>(s.steps) + s.run->steps() + 1, s.run->t());
  } catch (const callback_error& failure) {
    throw callback_error(
        fmt::format("{} [step {}, t = {:.10g}]", failure.what(), s.steps + s.run->steps() + 1, s.run->t()));
  }
}

}  // namespace
}  // namespace apsis::c

using namespace apsis::c;

int apsis_new_integrator(const apsis_method* method, size_t n, apsis_integrator** integrator) {
  return guarded([=] {
    require(integrator, "the place of the integrator") = nullptr;
    const auto& m = require(method, "the method");
    if (n == 0) throw apsis::input_error("there are no unknowns (n = 0); give n ≥ 1");
    *integrator = new apsis_integrator{.method = m.integrator, .n = n};
    (*integrator)->of.block_size = n;
    return APSIS_OK;
  });
}

void apsis_free_integrator(apsis_integrator* integrator) {
  delete integrator;
}

int apsis_set_data(apsis_integrator* integrator, void* data) {
  return guarded([=] {
    idle(integrator).of.data = data;
    return APSIS_OK;
  });
}

int apsis_set_observer(apsis_integrator* integrator, apsis_observer_function* observer) {
  return guarded([=] {
    idle(integrator).of.observer = observer;
    return APSIS_OK;
  });
}

int apsis_set_transport(apsis_integrator* integrator, apsis_transport_function* transport) {
  return set(integrator, [=](auto& s) { s.of.transport = transport; });
}

int apsis_set_stage(apsis_integrator* integrator, apsis_stage_function* stage) {
  return set(integrator, [=](auto& s) { s.of.stage = stage; });
}

int apsis_set_rate(apsis_integrator* integrator, apsis_rate_function* rate) {
  return set(integrator, [=](auto& s) { s.of.rate = rate; });
}

int apsis_set_jacobian(apsis_integrator* integrator, apsis_jacobian_function* jacobian) {
  return set(integrator, [=](auto& s) { s.of.jacobian = jacobian; });
}

int apsis_set_product(apsis_integrator* integrator, apsis_product_function* product) {
  return set(integrator, [=](auto& s) { s.of.product = product; });
}

int apsis_set_curvature(apsis_integrator* integrator, apsis_curvature_function* curvature) {
  return set(integrator, [=](auto& s) { s.of.curvature = curvature; });
}

int apsis_set_flow(apsis_integrator* integrator, apsis_flow_function* flow) {
  return set(integrator, [=](auto& s) { s.of.flow = flow; });
}

int apsis_set_admissible(apsis_integrator* integrator, apsis_admissible_function* admissible) {
  return set(integrator, [=](auto& s) { s.of.admissible = admissible; });
}

int apsis_set_relaxation_time(apsis_integrator* integrator, apsis_time_function* relaxation_time) {
  return set(integrator, [=](auto& s) { s.of.relaxation_time = relaxation_time; });
}

int apsis_set_forward_euler_step(apsis_integrator* integrator, apsis_time_function* step) {
  return set(integrator, [=](auto& s) { s.of.forward_euler_step = step; });
}

int apsis_set_block_size(apsis_integrator* integrator, size_t size) {
  return set(integrator, [=](auto& s) {
    if (size == 0 || s.n % size != 0)
      throw apsis::input_error(fmt::format(
          "{} unknowns are not a sequence of blocks of {} (it does not divide them); give a divisor", s.n,
          size));
    s.of.block_size = size;
  });
}

int apsis_set_dense_limit(apsis_integrator* integrator, size_t unknowns) {
  return set(integrator, [=](auto& s) { s.of.dense_limit = unknowns; });
}

int apsis_set_step(apsis_integrator* integrator, double dt) {
  return set(integrator, [=](auto& s) {
    if (!(dt >= 0.0) || !std::isfinite(dt))
      throw apsis::input_error(
          fmt::format("dt is {} (a length is needed); give dt > 0, or 0 to remove it", dt));
    s.limits.dt.reset();
    if (dt > 0.0) s.limits.dt = dt;
  });
}

int apsis_set_safety(apsis_integrator* integrator, double safety) {
  return set(integrator, [=](auto& s) {
    if (!(safety > 0.0) || !std::isfinite(safety))
      throw apsis::input_error(
          fmt::format("the safety is {} (a positive factor is needed); give one", safety));
    s.limits.safety = safety;
  });
}

int apsis_set_tolerance(apsis_integrator* integrator, double relative, double absolute) {
  return set(integrator, [=](auto& s) {
    const bool none = relative == 0.0 && absolute == 0.0;
    set_tolerances(s, relative, none ? numbers() : numbers(s.n, absolute));
  });
}

int apsis_set_tolerances(apsis_integrator* integrator, double relative, const double* absolute) {
  return set(integrator, [=](auto& s) {
    const double* all = &require(absolute, "the list of absolute tolerances");
    set_tolerances(s, relative, numbers(all, all + s.n));
  });
}

int apsis_set_graded_start(apsis_integrator* integrator, int growth) {
  return set(integrator, [=](auto& s) {
    if (growth != 0 && (growth < 2 || growth > apsis::largest_growth))
      throw apsis::input_error(fmt::format(
          "the growth of a graded start is {} (the ratio of its times is from 2 to {}); give one in "
          "this range, or 0 to remove it",
          growth, apsis::largest_growth));
    s.limits.growth = growth;
  });
}

int apsis_start(apsis_integrator* integrator, double t0, const double* u0) {
  return guarded([=] {
    apsis_integrator& s = idle(integrator);
    const double* given = &require(u0, "the initial state");
    if (!std::isfinite(t0)) throw apsis::input_error("the initial time is not finite; give a number");
    require_finite_state({given, s.n});
    numbers u(given, given + s.n);
    s.run.reset();
    s.t = t0;
    s.u.swap(u);
    s.steps = s.rejected = 0;
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

double apsis_time(const apsis_integrator* integrator) {
  if (integrator == nullptr) return std::numeric_limits<double>::quiet_NaN();
  return integrator->run ? integrator->run->t() : integrator->t;
}

const double* apsis_state(const apsis_integrator* integrator) {
  if (integrator == nullptr || !integrator->started) return nullptr;
  return integrator->run ? integrator->run->u().data() : integrator->u.data();
}

long long apsis_count(const apsis_integrator* integrator, int counter) {
  if (integrator == nullptr || counter < 0 || counter > APSIS_FLOW_EVALUATIONS) return -1;
  const auto* run = integrator->run.get();
  if (counter == APSIS_STEPS) return integrator->steps + (run != nullptr ? run->steps() : 0);
  if (counter == APSIS_REJECTED_STEPS) return integrator->rejected + (run != nullptr ? run->rejected() : 0);
  return integrator->of.counts[static_cast<std::size_t>(counter)];
}
