#pragma once

#include "petsc_problem.hpp"
#include "split_functions.hpp"
#include "stage_solver.hpp"
#include "vector.hpp"

#include <apsis/apsis_petsc.h>
#include <apsis/integrate/step_estimate.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/method.hpp>

#include <memory>
#include <optional>
#include <string>

#include <petsc/private/tsimpl.h>

namespace apsis::petsc {

/// Settings of a TS of type "apsis".
struct ts_settings {
  std::string method = "md-imex-8-3-mixed";
  bool fully_implicit = false;
  stage_settings stages{};
  std::optional<double> forward_euler_step{};  ///< a constant Δt_FE
  TSApsisForwardEulerStep* forward_euler = nullptr;
  void* forward_euler_context = nullptr;
};

/// The data of a TS of type "apsis": the stepper of its method, and the solutions of the last step.
class ts_apsis {
 public:
  explicit ts_apsis(TS ts);
  ~ts_apsis();
  ts_apsis(const ts_apsis&) = delete;
  ts_apsis& operator=(const ts_apsis&) = delete;

  /// Returns the data of a TS of this type.
  static ts_apsis& of(TS ts) { return *static_cast<ts_apsis*>(ts->data); }

  /// Sets the method. Throws input_error if it is unknown, or cannot be used.
  void set_method(const std::string& name);
  const method& the_method() const { return *method_; }
  ts_settings& settings() { return settings_; }
  stage_solver& stages() { return stages_; }
  /// Discards the stepper, because settings have changed.
  void forget() { stepper_.reset(); }

  // Operations of the TS.
  void set_up();
  void reset();
  void step();
  void roll_back();
  void interpolate(double t, Vec out);
  void evaluate_step(PetscInt order, Vec out, PetscBool* done);
  void evaluate_error(NormType norm, PetscInt* order, PetscReal* error);
  void view(PetscViewer viewer) const;

 private:
  bool wants_estimate() const;
  void prepare();
  double limited(double dt);
  bool try_step();
  void advance(double t, double dt, vector& u);
  bool choose_next(double wanted);

  TS ts_;
  ts_settings settings_;
  const method* method_ = nullptr;
  split_functions functions_;
  stage_solver stages_;
  petsc_problem problem_;
  std::optional<stepper<petsc_problem>> stepper_;
  bool estimates_ = false;         ///< whether the stepper computes two solutions
  const vector* other_ = nullptr;  ///< the second solution of the last step, if any
  vector start_,                   ///< u at the beginning of the last step
      now_,                        ///< its result
      inside_;                     ///< a solution inside it
  bool set_line_search_ = false;   ///< whether this type chose the line search of the SNES
};

}  // namespace apsis::petsc
