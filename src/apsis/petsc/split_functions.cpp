#include "internal/split_functions.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <petscdm.h>

namespace apsis::petsc {
namespace {

/// The callbacks of a TS.
struct callbacks_of {
  TSRHSFunction rhs = nullptr;
  TSRHSJacobian rhs_jacobian = nullptr;
  TSIFunction implicit = nullptr;
  TSIJacobian implicit_jacobian = nullptr;
  TSI2Function second_order = nullptr;

  explicit callbacks_of(TS ts) {
    DM dm = nullptr;
    check(TSGetDM(ts, &dm));
    check(DMTSGetRHSFunction(dm, &rhs, nullptr));
    check(DMTSGetRHSJacobian(dm, &rhs_jacobian, nullptr));
    check(DMTSGetIFunction(dm, &implicit, nullptr));
    check(DMTSGetIJacobian(dm, &implicit_jacobian, nullptr));
    check(DMTSGetI2Function(dm, &second_order, nullptr));
  }
};

}  // namespace

bool split_functions::has_transport() const {
  return !all_ && callbacks_of(ts_).rhs != nullptr;
}

bool split_functions::has_collision() const {
  const callbacks_of of(ts_);
  return of.implicit != nullptr || (all_ && of.rhs != nullptr);
}

bool split_functions::has_jacobian() const {
  const callbacks_of of(ts_);
  const bool of_rhs = !all_ || of.rhs == nullptr || of.rhs_jacobian != nullptr;
  return of_rhs && (of.implicit == nullptr || of.implicit_jacobian != nullptr);
}

bool split_functions::has_constant_jacobian() const {
  const callbacks_of of(ts_);
  return all_ && of.implicit == nullptr && of.rhs_jacobian == TSComputeRHSJacobianConstant;
}

void split_functions::transport(double t, Vec u, Vec out) const {
  check(TSComputeRHSFunction(ts_, t, u, out));
}

void split_functions::minus_collision(double t, Vec u, Vec out) {
  check(TSComputeIFunction(ts_, t, u, zero(u), out, all_ ? PETSC_FALSE : PETSC_TRUE));
}

void split_functions::minus_jacobian(double t, Vec u, Mat a, Mat p) {
  check(TSComputeIJacobian(ts_, t, u, zero(u), 0.0, a, p, all_ ? PETSC_FALSE : PETSC_TRUE));
}

void split_functions::minus_time_derivative(double t, double dt, Vec u, Vec out) {
  // The truncation error is about 1e-9 Q/Δt if Q changes on the time scale of the step; rounding errors are
  // smaller.
  const double tau = 1e-4 * std::max(std::abs(dt), 1e-6 * std::abs(t));
  const double before = t - tau, after = t + tau;
  minus_collision(after, u, out);
  minus_collision(before, u, work_.like(u));
  check(VecAXPY(out, -1.0, work_.get()));
  check(VecScale(out, 1.0 / (after - before)));
}

void split_functions::require_form(double t, Vec u) {
  TSEquationType type = TS_EQ_UNSPECIFIED;
  check(TSGetEquationType(ts_, &type));
  const bool explicit_dae = type >= TS_EQ_DAE_SEMI_EXPLICIT_INDEX1 && type < TS_EQ_IMPLICIT;
  if (explicit_dae || type >= TS_EQ_DAE_IMPLICIT_INDEX1)
    throw input_error(
        "the TS type 'apsis' cannot integrate a DAE (TSSetEquationType() declares one); use a type for DAEs, "
        "such as bdf");
  if (callbacks_of(ts_).second_order != nullptr)
    throw input_error(
        "the TS type 'apsis' cannot integrate an equation of second order (TSSetI2Function() was called); "
        "write it as a system of first order, or use the type alpha2");
  PetscBool transient = PETSC_FALSE;
  check(TSHasTransientVariable(ts_, &transient));
  if (transient == PETSC_TRUE)
    throw input_error(
        "the TS type 'apsis' cannot integrate transient variables (TSSetTransientVariable() was called, and "
        "methods need u' itself); use the type bdf");
  if (callbacks_of(ts_).implicit != nullptr) require_identity(t, u);
}

void split_functions::require_identity(double t, Vec u) {
  vector rate, difference;
  PetscReal size = 0.0;
  minus_collision(t, u, work_.like(u));
  check(VecNorm(work_.get(), NORM_INFINITY, &size));
  if (!std::isfinite(size))
    throw input_error(
        fmt::format("the IFunction is not finite at the start (t = {:g}); check the initial values", t));
  // A rate with different entries. It is as large as F, so that rounding errors of F are small.
  const double scale = std::max(size, 1.0);
  PetscInt begin = 0, end = 0;
  check(VecGetOwnershipRange(u, &begin, &end));
  PetscScalar* entries = nullptr;
  check(VecGetArray(rate.like(u), &entries));
  for (PetscInt i = begin; i < end; ++i)
    entries[i - begin] = scale * (1.5 + std::sin(static_cast<double>(i)));
  check(VecRestoreArray(rate.get(), &entries));
  check(TSComputeIFunction(ts_, t, u, rate.get(), difference.like(u), PETSC_TRUE));
  check(VecAXPY(difference.get(), -1.0, rate.get()));
  if (all_) check(TSComputeIFunction(ts_, t, u, zero(u), work_.get(), PETSC_TRUE));
  check(VecAXPY(difference.get(), -1.0, work_.get()));
  check(VecAbs(difference.get()));
  PetscInt row = 0;
  PetscReal largest = 0.0;
  check(VecMax(difference.get(), &row, &largest));
  // Allow for rounding errors of sums of some terms.
  if (largest <= 1e-10 * scale) return;
  throw input_error(
      fmt::format("the TS type 'apsis' needs F(t, u, u') = u' - Q(t, u) (row {} of the IFunction has another "
                  "dependence on "
                  "u': a mass matrix or an algebraic equation); multiply by the inverse mass matrix, or use "
                  "a type for such "
                  "problems, such as bdf",
                  row));
}

Vec split_functions::zero(Vec like) {
  if (!zero_) check(VecZeroEntries(zero_.like(like)));
  return zero_.get();
}

void split_functions::reset() {
  zero_.reset();
  work_.reset();
}

}  // namespace apsis::petsc
