#include "internal/petsc_problem.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <petscts.h>

namespace apsis::petsc {

template <class Rate>
void petsc_problem::add(const state& u, targets to, const Rate& rate) {
  const bool needed = std::any_of(to.begin(), to.end(), [](const auto& one) { return one.beta != 0.0; });
  const Vec k = needed ? rate() : nullptr;
  for (const auto& [acc, alpha, beta, fresh] : to) {
    const Vec sum = acc->get();
    if (!fresh && beta != 0.0) {
      check(VecAXPBYPCZ(sum, alpha, beta, 1.0, u.get(), k));
    } else if (!fresh) {
      check(VecAXPY(sum, alpha, u.get()));
    } else if (beta != 0.0 && alpha == 1.0) {
      check(VecWAXPY(sum, beta, k, u.get()));
    } else {
      // The old content may be NaN, which a coefficient 0 would keep.
      if (sum != u.get()) check(VecCopy(u.get(), sum));
      if (alpha != 1.0) check(VecScale(sum, alpha));
      if (beta != 0.0) check(VecAXPY(sum, beta, k));
    }
  }
}

void petsc_problem::add_transport(double t, const state& u, targets to) {
  add(u, to, [&] {
    const Vec rate = rate_.like(u.get());
    if (of_.has_transport())
      of_.transport(t, u.get(), rate);
    else
      check(VecZeroEntries(rate));
    return rate;
  });
}

void petsc_problem::add_collision(double t, const state& u, targets to) {
  add(u, to, [&] {
    const Vec rate = rate_.like(u.get());
    if (of_.has_collision())
      of_.minus_collision(t, u.get(), rate);
    else
      check(VecZeroEntries(rate));
    check(VecScale(rate, -1.0));
    return rate;
  });
}

void petsc_problem::add_transport_and_collision(double t, const state& u, targets to) {
  if (!of_.has_collision()) return add_transport(t, u, to);
  if (!of_.has_transport()) return add_collision(t, u, to);
  add(u, to, [&] {
    const Vec rate = rate_.like(u.get()), other = more_.like(u.get());
    of_.transport(t, u.get(), rate);
    of_.minus_collision(t, u.get(), other);
    check(VecAXPY(rate, -1.0, other));
    return rate;
  });
}

void petsc_problem::solve(const stage& now, state& u) {
  const TS ts = of_.ts();
  if (of_ts_) check(TSPreStage(ts, now.t));
  const bool solved = !of_.has_collision() || (now.a == 0.0 && now.b == 0.0) || stages_.solve(now, u.get());
  if (!of_ts_) {
    if (solved) return;
    throw numerical_error(
        fmt::format("a stage of dense output is not solved (SNES ends with {}); reduce the step",
                    SNESConvergedReasons[stages_.reason()]));
  }
  if (solved) {
    Vec stage = u.get();
    check(TSPostStage(ts, now.t, 0, &stage));
  }
  TSAdapt adapt = nullptr;
  PetscBool accepted = PETSC_FALSE;
  check(TSGetAdapt(ts, &adapt));
  check(TSAdaptCheckStage(adapt, ts, now.t, u.get(), &accepted));
  if (accepted == PETSC_FALSE)
    throw rejected_stage(
        "a stage is rejected (by its solver, or by a function of the program); reduce the step");
}

}  // namespace apsis::petsc
