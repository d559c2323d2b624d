#include "internal/guarded.hpp"
#include "internal/idle.hpp"
#include "internal/integrator_handle.hpp"

#include <apsis/apsis.h>
#include <apsis/core/graded_start.hpp>
#include <apsis/integrate/evolution.hpp>
#include <apsis/method/step_law.hpp>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis::c {
namespace {

/// Ends a run, because other settings need another one.
void end_run(apsis_integrator& s) {
  if (!s.run) return;
  s.t = s.run->t();
  s.u = s.run->u();
  s.steps += s.run->steps();
  s.rejected += s.run->rejected();
  s.found.insert(s.found.end(), s.run->found().begin(), s.run->found().end());
  s.run.reset();
}

/// Changes settings by change(integrator), and ends the run.
template <class Change>
int set(apsis_integrator* integrator, const Change& change) {
  return guarded([&] {
    apsis_integrator& s = idle(integrator);
    change(s);
    end_run(s);
    return APSIS_OK;
  });
}

/// Returns a length of steps, nothing for 0. Throws input_error for other numbers that are not positive.
std::optional<double> length_of(const char* what, double dt) {
  if (!(dt >= 0.0) || !std::isfinite(dt))
    throw input_error(fmt::format("{} is {} (a length is needed); give dt > 0, or 0 to remove it", what, dt));
  return dt > 0.0 ? std::optional(dt) : std::nullopt;
}

void set_tolerances(apsis_integrator& s, double relative, numbers absolute) {
  if (!(relative >= 0.0) || !std::isfinite(relative))
    throw input_error(fmt::format(
        "the relative tolerance is {} (it must be finite and at least 0); give for example 1e-6", relative));
  for (const double one : absolute)
    if (!(one > 0.0) || !std::isfinite(one))
      throw input_error(
          fmt::format("an absolute tolerance is {} (it must be finite and above 0); change it", one));
  s.limits.relative = relative;
  s.limits.absolute = std::move(absolute);
}

}  // namespace
}  // namespace apsis::c

using namespace apsis::c;

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

int apsis_set_timed_rate(apsis_integrator* integrator, apsis_timed_rate_function* rate) {
  return set(integrator, [=](auto& s) { s.of.timed_rate = rate; });
}

int apsis_set_timed_product(apsis_integrator* integrator, apsis_timed_product_function* product) {
  return set(integrator, [=](auto& s) { s.of.timed_product = product; });
}

int apsis_set_sparsity(apsis_integrator* integrator, size_t count, const size_t* rows,
                       const size_t* columns) {
  return set(integrator, [=](auto& s) {
    if (count == 0) return s.of.pattern.reset();
    const size_t *of_rows = &require(rows, "the list of rows"),
                 *of_columns = &require(columns, "the list of columns");
    std::vector<apsis::sparsity_pattern::place> places;
    for (size_t k = 0; k < count; ++k) places.emplace_back(of_rows[k], of_columns[k]);
    s.of.pattern.emplace(s.of.block_size, places);
  });
}

int apsis_set_preconditioner(apsis_integrator* integrator, apsis_prepare_function* prepare,
                             apsis_precondition_function* solve) {
  return set(integrator, [=](auto& s) {
    if (prepare != nullptr && solve == nullptr)
      throw apsis::input_error(
          "a preconditioner is prepared and not applied (its second function is NULL); give one, or remove "
          "both");
    s.of.prepare = prepare;
    s.of.precondition = solve;
  });
}

int apsis_set_mass(apsis_integrator* integrator, size_t count, const size_t* rows, const size_t* columns,
                   const double* values) {
  return set(integrator, [=](auto& s) {
    if (count == 0) return s.of.mass.reset();
    const size_t *of_rows = &require(rows, "the list of rows"),
                 *of_columns = &require(columns, "the list of columns");
    const double* of_values = &require(values, "the list of values");
    std::vector<apsis::mass_matrix<double>::entry> entries;
    for (size_t k = 0; k < count; ++k) entries.push_back({of_rows[k], of_columns[k], of_values[k]});
    s.of.mass.emplace(s.of.block_size, entries);
  });
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
  return set(integrator, [=](auto& s) { s.limits.dt = length_of("dt", dt); });
}

int apsis_set_first_step(apsis_integrator* integrator, double dt) {
  return set(integrator, [=](auto& s) { s.limits.first_step = length_of("the first step", dt); });
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

int apsis_set_controller(apsis_integrator* integrator, const char* name) {
  return set(integrator, [=](auto& s) {
    s.limits.controller = apsis::find_step_law(&require(name, "the name of the controller")).name;
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

int apsis_set_event_observer(apsis_integrator* integrator, apsis_event_observer_function* observer) {
  return guarded([=] {
    idle(integrator).of.event_observer = observer;
    return APSIS_OK;
  });
}

int apsis_set_events(apsis_integrator* integrator, size_t count, apsis_event_function* events,
                     const int* directions, const int* ends) {
  return set(integrator, [=](auto& s) {
    if (count > 0) require_function(events, "the function of the events");
    const auto list = [count](const int* from) {
      return from == nullptr ? std::vector<int>() : std::vector<int>(from, from + count);
    };
    std::vector<int> both = list(directions), last = list(ends);
    for (const int one : both)
      if (one < -1 || one > 1)
        throw apsis::input_error(
            fmt::format("the direction of an event is {} (valid: -1, 0, 1); give one", one));
    s.of.events = events;
    s.events.count = count;
    s.events.directions.swap(both);
    s.events.ends.swap(last);
  });
}

int apsis_set_stop_times(apsis_integrator* integrator, size_t count, const double* times) {
  return set(integrator, [=](auto& s) {
    const double* all = count == 0 ? nullptr : &require(times, "the list of stop times");
    numbers stops(all, all + count);
    apsis::require_increasing(stops);
    s.events.stops.swap(stops);
  });
}
