#pragma once

#include <apsis/integrate/time_marcher.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/method/multistep.hpp>
#include <apsis/run/run_state.hpp>
#include <apsis/semidiscrete/budgeted_problem.hpp>

#include <functional>
#include <memory>

namespace apsis {

/// Takes the steps of a run by a multistep method: as integrate(), but where the length of a step changes,
/// the method begins again with its starter.
class multistep_stepper {
 public:
  virtual ~multistep_stepper() = default;

  /// Advances u by the step dt that `march` gave. If a stage throws, u is the old value, and the next steps
  /// are those of the starter.
  virtual void step(const time_marcher<double>& march, double dt, budgeted_state& u) = 0;

  /// Calls visit(v, w) for every v that later steps need in addition to u: the sum of earlier u, with weights
  /// that add up to w, and of their transport.
  virtual void visit_kept(const std::function<void(budgeted_state&, double)>& visit) = 0;

  /// Returns the state for a checkpoint.
  virtual multistep_progress save() const = 0;
  /// Continues from `saved`; visit_kept() then gives the places of the kept values, states like `like`.
  virtual void resume(const multistep_progress& saved, const budgeted_state& like) = 0;
};

/// Returns the stepper of a multistep method. `problem` must outlive it.
std::unique_ptr<multistep_stepper> make_multistep_stepper(const multistep_method& m,
                                                          budgeted_problem& problem);

/// Returns the number of fields that a step needs, u included: those of the method and of its starter.
int buffers_of(const multistep_method& m);

}  // namespace apsis
