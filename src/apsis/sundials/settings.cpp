#include "internal/integrator_handle.hpp"

#include <apsis/c/internal/guarded.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/graded_start.hpp>
#include <apsis/method/step_law.hpp>

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace apsis::sundials {
namespace {

/// Changes settings by change(integrator), and ends the run.
template <class Change>
int set(apsis_sundials* integrator, const Change& change) {
  return c::guarded([&] {
    apsis_sundials& s = idle(integrator);
    change(s);
    end_run(s);
    return APSIS_OK;
  });
}

void require_relative(double relative) {
  if (!(relative >= 0.0) || !std::isfinite(relative))
    throw input_error(fmt::format(
        "the relative tolerance is {} (it must be finite and at least 0); give for example 1e-6", relative));
}

void require_positive(const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw input_error(fmt::format("{} is {} (it must be finite and above 0); change it", name, value));
}

/// Throws input_error for pairs that linear_systems cannot use.
void require_pair(SUNLinearSolver solver, SUNMatrix matrix) {
  if (solver == nullptr) {
    if (matrix != nullptr)
      throw input_error("a matrix is given without a linear solver (which fills it); give both");
    return;
  }
  switch (SUNLinSolGetType(solver)) {
    case SUNLINEARSOLVER_ITERATIVE:
      if (matrix != nullptr)
        throw input_error(
            "the linear solver is iterative and a matrix is given (it multiplies by products); remove the "
            "matrix, or "
            "give a direct solver");
      return;
    case SUNLINEARSOLVER_DIRECT:
    case SUNLINEARSOLVER_MATRIX_ITERATIVE:
      if (matrix == nullptr)
        throw input_error(
            "the linear solver needs a matrix (it is NULL); give the matrix with which it was made");
      if (matrix->ops->matvec == nullptr || matrix->ops->scaleaddi == nullptr ||
          matrix->ops->copy == nullptr || matrix->ops->clone == nullptr)
        throw input_error(
            "the matrix lacks an operation (clone, copy, c A + I and products are needed); choose another "
            "kind");
      return;
    default:
      throw input_error(
          "the linear solver contains the whole matrix (its type is matrix-embedded); give a direct or an "
          "iterative "
          "one");
  }
}

}  // namespace
}  // namespace apsis::sundials

using namespace apsis::sundials;
using apsis::input_error;
using apsis::c::guarded;

int apsis_sundials_set_user_data(apsis_sundials* integrator, void* data) {
  return guarded([=] {
    idle(integrator).of.data = data;
    return APSIS_OK;
  });
}

int apsis_sundials_set_observer(apsis_sundials* integrator, apsis_sundials_observer* observer) {
  return guarded([=] {
    idle(integrator).of.observer = observer;
    return APSIS_OK;
  });
}

int apsis_sundials_set_stage(apsis_sundials* integrator, apsis_sundials_stage_function* stage) {
  return set(integrator, [=](auto& s) { s.of.stage = stage; });
}

int apsis_sundials_set_linear_solver(apsis_sundials* integrator, SUNLinearSolver solver, SUNMatrix matrix) {
  return set(integrator, [=](auto& s) {
    require_pair(solver, matrix);
    s.of.solver = solver;
    s.of.matrix = matrix;
  });
}

int apsis_sundials_set_products(apsis_sundials* integrator, apsis_sundials_product_setup* setup,
                                apsis_sundials_product_function* product) {
  return set(integrator, [=](auto& s) {
    if (setup != nullptr && product == nullptr)
      throw input_error("products with the Jacobian are prepared (and the product is NULL); give it");
    s.of.product_setup = setup;
    s.of.product = product;
  });
}

int apsis_sundials_set_jacobian(apsis_sundials* integrator, apsis_sundials_jacobian_function* jacobian) {
  return set(integrator, [=](auto& s) { s.of.jacobian = jacobian; });
}

int apsis_sundials_set_preconditioner(apsis_sundials* integrator, apsis_sundials_preconditioner_setup* setup,
                                      apsis_sundials_preconditioner_solve* solve) {
  return set(integrator, [=](auto& s) {
    if (setup != nullptr && solve == nullptr)
      throw input_error("a preconditioner is prepared (and what solves it is NULL); give it");
    s.of.preconditioner_setup = setup;
    s.of.preconditioner = solve;
  });
}

int apsis_sundials_set_step(apsis_sundials* integrator, sunrealtype dt) {
  return set(integrator, [=](auto& s) {
    if (dt != 0.0) require_positive("dt", dt);
    s.limits.dt = dt != 0.0 ? std::optional(dt) : std::nullopt;
  });
}

int apsis_sundials_set_first_step(apsis_sundials* integrator, sunrealtype dt) {
  return set(integrator, [=](auto& s) {
    if (dt != 0.0) require_positive("the first step", dt);
    s.limits.first_step = dt != 0.0 ? std::optional(dt) : std::nullopt;
  });
}

int apsis_sundials_set_forward_euler_step(apsis_sundials* integrator, apsis_sundials_time_function* step) {
  return set(integrator, [=](auto& s) { s.of.forward_euler_step = step; });
}

int apsis_sundials_set_safety(apsis_sundials* integrator, sunrealtype safety) {
  return set(integrator, [=](auto& s) {
    require_positive("safety", safety);
    s.limits.safety = safety;
  });
}

int apsis_sundials_set_tolerance(apsis_sundials* integrator, sunrealtype relative, sunrealtype absolute) {
  return set(integrator, [=](auto& s) {
    require_relative(relative);
    if (relative == 0.0 && absolute == 0.0) {
      s.accuracy.absolute = nvector();
      return;
    }
    require_positive("the absolute tolerance", absolute);
    nvector one = s.u.another();
    N_VConst(absolute, one.get());
    s.accuracy.relative = relative;
    s.accuracy.absolute.swap(one);
  });
}

int apsis_sundials_set_tolerances(apsis_sundials* integrator, sunrealtype relative, N_Vector absolute) {
  return set(integrator, [=](auto& s) {
    require_relative(relative);
    apsis::c::require(absolute, "the vector of absolute tolerances");
    require_length(s, absolute);
    require_operation("nvmin", absolute->ops->nvmin != nullptr, "tolerances of unknowns call it");
    nvector all(absolute);
    if (!is_finite(all.get()) || !(N_VMin(all.get()) > 0.0))
      throw input_error(
          "an absolute tolerance is not positive and finite (every unknown needs one); change it");
    s.accuracy.relative = relative;
    s.accuracy.absolute.swap(all);
  });
}

int apsis_sundials_set_controller(apsis_sundials* integrator, const char* name) {
  return set(integrator, [=](auto& s) {
    s.limits.controller = apsis::find_step_law(&apsis::c::require(name, "the name of the controller")).name;
  });
}

int apsis_sundials_set_constraints(apsis_sundials* integrator, N_Vector constraints) {
  return set(integrator, [=](auto& s) {
    if (constraints != nullptr) {
      require_length(s, constraints);
      require_operation("nvconstrmask", constraints->ops->nvconstrmask != nullptr, "constraints call it");
    }
    nvector all(constraints);
    if (all && !(N_VMaxNorm(all.get()) <= 2.0))
      throw input_error("a constraint is not -2, -1, 0, 1 or 2 (ARKODE defines them so); give one of these");
    s.accuracy.constraints.swap(all);
  });
}

int apsis_sundials_set_relaxation_time(apsis_sundials* integrator, apsis_sundials_time_function* time) {
  return set(integrator, [=](auto& s) { s.of.relaxation_time = time; });
}

int apsis_sundials_set_graded_start(apsis_sundials* integrator, int growth) {
  return set(integrator, [=](auto& s) {
    if (growth != 0 && (growth < 2 || growth > apsis::largest_growth))
      throw input_error(
          fmt::format("the growth of a graded start is {} (the ratio of its times is from 2 to {}); give one "
                      "in this range, or "
                      "0 to remove it",
                      growth, apsis::largest_growth));
    s.limits.growth = growth;
  });
}

int apsis_sundials_set_events(apsis_sundials* integrator, size_t count, apsis_sundials_root_function* roots,
                              const int* directions, const int* ends) {
  return set(integrator, [=](auto& s) {
    if (count > 0) apsis::c::require_function(roots, "the function of events");
    for (std::size_t k = 0; directions != nullptr && k < count; ++k)
      if (directions[k] < -1 || directions[k] > 1)
        throw input_error(fmt::format(
            "direction {} of an event is {} (it has no such meaning); give -1, 0 or 1", k, directions[k]));
    s.of.roots = roots;
    s.events.count = count;
    s.events.directions.assign(directions, directions != nullptr ? directions + count : directions);
    s.events.ends.assign(ends, ends != nullptr ? ends + count : ends);
  });
}

int apsis_sundials_set_stop_times(apsis_sundials* integrator, size_t count, const sunrealtype* times) {
  return set(integrator, [=](auto& s) {
    if (count > 0) apsis::c::require(times, "the list of stop times");
    std::vector<double> all(times, count > 0 ? times + count : times);
    apsis::require_increasing(all);
    s.events.stops = std::move(all);
  });
}
