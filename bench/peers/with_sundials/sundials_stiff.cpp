// CVODE and ARKODE on the stiff problems of the literature.
#include "field_vector.hpp"
#include "peers/stiff_set.hpp"

#include <algorithm>
#include <vector>

#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>

namespace apsis::bench::peers {
namespace {

stiff_system& system_of(void* data) {
  return *static_cast<stiff_system*>(data);
}

int stiff_rate_of(realtype t, N_Vector y, N_Vector out, void* data) {
  system_of(data).rate(t, N_VGetArrayPointer(y), N_VGetArrayPointer(out));
  return 0;
}

int stiff_jacobian_of(realtype t, N_Vector y, N_Vector, SUNMatrix out, void* data, N_Vector, N_Vector,
                      N_Vector) {
  stiff_system& system = system_of(data);
  const auto at = [](std::size_t i) { return static_cast<sunindextype>(i); };
  if (system.is_banded())
    system.jacobian(t, N_VGetArrayPointer(y), [&](std::size_t i, std::size_t j, double value) {
      SM_ELEMENT_B(out, at(i), at(j)) = value;
    });
  else
    system.jacobian(t, N_VGetArrayPointer(y), [&](std::size_t i, std::size_t j, double value) {
      SM_ELEMENT_D(out, at(i), at(j)) = value;
    });
  return 0;
}

/// Vectors, matrix and linear solver of one integration.
class sundials_stiff {
 public:
  sundials_stiff(const stiff_problem_entry& problem, const stiff_limits& limits)
      : limits_(limits),
        system_(problem),
        y_(N_VNew_Serial(n(), context_.get())),
        absolute_(N_VClone(y_.get())),
        clock_(limits.seconds) {
    const auto start = problem.start(), absolute = absolute_tolerances(problem, limits.rtol);
    std::copy(start.begin(), start.end(), N_VGetArrayPointer(y_.get()));
    std::copy(absolute.begin(), absolute.end(), N_VGetArrayPointer(absolute_.get()));
    const auto width = static_cast<sunindextype>(system_.width());
    matrix_ = system_.is_banded() ? SUNBandMatrix(n(), width, width, context_.get())
                                  : SUNDenseMatrix(n(), n(), context_.get());
    linear_ = system_.is_banded() ? SUNLinSol_Band(y_.get(), matrix_, context_.get())
                                  : SUNLinSol_Dense(y_.get(), matrix_, context_.get());
    system_.begin(0);
  }
  sundials_stiff(const sundials_stiff&) = delete;
  sundials_stiff& operator=(const sundials_stiff&) = delete;
  ~sundials_stiff() {
    SUNLinSolFree(linear_);
    SUNMatDestroy(matrix_);
  }

  stiff_outcome by_cvode() {
    void* memory = CVodeCreate(CV_BDF, context_.get());
    const bool ready =
        CVodeSetErrFile(memory, nullptr) == 0 && CVodeInit(memory, stiff_rate_of, 0.0, y_.get()) == 0 &&
        CVodeSetUserData(memory, &system_) == 0 &&
        CVodeSVtolerances(memory, limits_.rtol, absolute_.get()) == 0 &&
        CVodeSetLinearSolver(memory, linear_, matrix_) == 0 && CVodeSetJacFn(memory, stiff_jacobian_of) == 0;
    auto found = march(
        ready, [&](double t) { return CVodeReInit(memory, t, y_.get()); },
        [&](double end) { return CVodeSetStopTime(memory, end); },
        [&](double end, double& t) { return CVode(memory, end, y_.get(), &t, CV_ONE_STEP); });
    CVodeFree(&memory);
    return found;
  }

  stiff_outcome by_arkode(int order) {
    void* memory = ARKStepCreate(nullptr, stiff_rate_of, 0.0, y_.get(), context_.get());
    const bool ready = ARKStepSetErrFile(memory, nullptr) == 0 && ARKStepSetUserData(memory, &system_) == 0 &&
                       ARKStepSetOrder(memory, order) == 0 &&
                       ARKStepSVtolerances(memory, limits_.rtol, absolute_.get()) == 0 &&
                       ARKStepSetLinearSolver(memory, linear_, matrix_) == 0 &&
                       ARKStepSetJacFn(memory, stiff_jacobian_of) == 0 &&
                       ARKStepSetDeduceImplicitRhs(memory, SUNTRUE) == 0 &&
                       // With its default of 7, half of the integrations fail.
                       ARKStepSetMaxErrTestFails(memory, 30) == 0 && ARKStepSetMaxConvFails(memory, 30) == 0;
    auto found = march(
        ready, [&](double t) { return ARKStepReInit(memory, nullptr, stiff_rate_of, t, y_.get()); },
        [&](double end) { return ARKStepSetStopTime(memory, end); },
        [&](double end, double& t) { return ARKStepEvolve(memory, end, y_.get(), &t, ARK_ONE_STEP); });
    ARKStepFree(&memory);
    return found;
  }

 private:
  sunindextype n() const { return static_cast<sunindextype>(system_.size()); }

  template <class Restart, class Stop, class Step>
  stiff_outcome march(bool ready, const Restart& restart, const Stop& stop, const Step& step) {
    stiff_outcome found;
    const auto& times = system_.problem().times;
    if (!ready) found.failure = "failed";
    for (std::size_t piece = 0; piece + 1 < times.size() && found.failure.empty(); ++piece) {
      system_.begin(piece);
      const double end = times[piece + 1];
      double t = times[piece];
      if (restart(t) < 0 || stop(end) < 0) found.failure = "failed";
      while (t < end && found.failure.empty()) {
        if (step(end, t) < 0) found.failure = "failed";
        if (clock_.is_over()) found.failure = too_slow;
        ++found.steps;
      }
    }
    const double* y = N_VGetArrayPointer(y_.get());
    found.u.assign(y, y + n());
    found.rates = system_.rates();
    found.jacobians = static_cast<double>(system_.jacobians());
    return found;
  }

  stiff_limits limits_;
  owned_context context_ = make_context();
  stiff_system system_;
  owned_vector y_, absolute_;
  stiff_clock clock_;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
};

}  // namespace

stiff_outcome run_cvode_stiff(const stiff_problem_entry& problem, const stiff_limits& limits) {
  return sundials_stiff(problem, limits).by_cvode();
}

stiff_outcome run_arkode_stiff(const stiff_problem_entry& problem, int order, const stiff_limits& limits) {
  return sundials_stiff(problem, limits).by_arkode(order);
}

}  // namespace apsis::bench::peers
