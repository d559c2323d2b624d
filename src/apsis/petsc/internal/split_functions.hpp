#pragma once

#include "vector.hpp"

#include <petscts.h>

namespace apsis::petsc {

/// T and Q of a TS. T is its RHSFunction, and Q(t, u) = −F(t, u, 0) with its IFunction F(t, u, u') = u' −
/// Q(t, u). If the problem is fully implicit, T = 0 and Q contains the RHSFunction.
class split_functions {
 public:
  /// Stores the TS.
  explicit split_functions(TS ts) : ts_(ts) {}

  TS ts() const { return ts_; }
  void set_fully_implicit(bool all) { all_ = all; }
  bool fully_implicit() const { return all_; }

  bool has_transport() const;
  bool has_collision() const;
  /// Whether all parts of Q come with a Jacobian.
  bool has_jacobian() const;
  /// Whether the Jacobian of Q never changes.
  bool has_constant_jacobian() const;

  /// out ← T(t, u).
  void transport(double t, Vec u, Vec out) const;
  /// out ← −Q(t, u).
  void minus_collision(double t, Vec u, Vec out);
  /// a, p ← −∂Q/∂u (t, u), by the callbacks of the TS.
  void minus_jacobian(double t, Vec u, Mat a, Mat p);
  /// out ← −∂Q/∂t (t, u), by central differences over a small part of the step dt.
  void minus_time_derivative(double t, double dt, Vec u, Vec out);

  /// Throws input_error unless F(t, u, u') = u' − Q(t, u), and for equations of second order, transient
  /// variables and DAEs.
  void require_form(double t, Vec u);

  /// Releases the work vectors.
  void reset();

 private:
  Vec zero(Vec like);
  void require_identity(double t, Vec u);

  TS ts_;
  bool all_ = false;
  vector zero_, work_;
};

}  // namespace apsis::petsc
