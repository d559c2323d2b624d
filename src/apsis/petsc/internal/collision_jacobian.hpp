#pragma once

#include "handle.hpp"
#include "split_functions.hpp"
#include "vector.hpp"

#include <petscsnes.h>

namespace apsis::petsc {

/// Where products with ∂Q/∂u come from.
enum class jacobian_source {
  callback,   ///< the IJacobian, in fully implicit problems also the RHSJacobian
  coloring,   ///< differences of Q, one for each color of the columns
  difference  ///< one difference of Q for each product
};

/// Matrices that the SNES of the program has for the Jacobian, and their sources.
struct jacobian_choice {
  jacobian_source products = jacobian_source::callback;  ///< source of the products
  jacobian_source entries = jacobian_source::callback;   ///< source of the assembled matrix; `difference`
                                                         ///< without one
  mat a, p;                                              ///< for products and entries
};

/// Chooses the source by the callbacks of the TS and by the options -snes_fd, -snes_fd_color, -snes_mf and
/// -snes_mf_operator of its SNES. Without an IJacobian, columns are colored if the DM provides a matrix.
jacobian_choice choose_jacobian(const split_functions& of, SNES snes);

/// J = ∂Q/∂u at one state, stored as −J, because F contains −Q.
class collision_jacobian {
 public:
  /// Stores a reference. With `constant`, J is evaluated only at the first state.
  collision_jacobian(split_functions& of, jacobian_choice choice, bool constant);

  /// Evaluates J at a time and a state, unless the last evaluation was there.
  void evaluate(double t, Vec u);
  /// y ← −J x. Requires evaluate().
  void minus_product(Vec x, Vec y);
  /// Returns the assembled matrix −J; nullptr without one.
  Mat entries() const { return choice_.p.get(); }
  /// Returns a number that changes with J.
  long version() const { return version_; }
  bool constant() const { return constant_; }
  /// Returns about ‖J‖: the maximum norm if J is assembled, otherwise ‖Jx‖/‖x‖.
  double size(Vec x);

 private:
  void make_coloring();
  void make_difference(Vec u);

  split_functions& of_;
  jacobian_choice choice_;
  bool constant_;
  fd_coloring coloring_;
  vector at_, work_;
  double t_ = 0.0;
  long version_ = 0;
};

}  // namespace apsis::petsc
