#pragma once

#include "functions.hpp"
#include "nvector.hpp"

namespace apsis::sundials {

/// A callback that refused a state or failed, kept until C code has returned.
struct refusal {
  const char* name = nullptr;
  int returned = 0;

  explicit operator bool() const { return name != nullptr; }
  /// Stores the first nonzero result, and returns it.
  int keep(const char* of, int result) {
    if (result != 0 && name == nullptr) *this = {of, result};
    return result;
  }
};

/// Owns a matrix of SUNDIALS.
class owned_matrix {
 public:
  owned_matrix() = default;
  /// Makes a matrix like another. Throws std::bad_alloc.
  explicit owned_matrix(SUNMatrix like);
  owned_matrix(owned_matrix&& other) noexcept : m_(other.m_) { other.m_ = nullptr; }
  owned_matrix& operator=(owned_matrix&& other) noexcept {
    std::swap(m_, other.m_);
    return *this;
  }
  ~owned_matrix() {
    if (m_ != nullptr) SUNMatDestroy(m_);
  }
  SUNMatrix get() const { return m_; }

 private:
  SUNMatrix m_ = nullptr;
};

/// J = ∂Q/∂y at a state: products by the program, by a matrix, or by central differences of Q.
class jacobian {
 public:
  /// Stores a reference; vectors are made like `like`.
  jacobian(functions& of, const nvector& like);

  /// Moves to the state v at t with k = Q(t, v). Neither v nor k may change afterwards. Lets the program
  /// prepare its products. Returns 0, or what a callback returned.
  int move_to(double t, N_Vector v, N_Vector k);
  /// Evaluates the matrix at this state unless it is known. Returns 0, or what a callback returned.
  int evaluate_matrix();
  /// jx ← J x. Returns 0, or what a callback returned.
  int product(N_Vector x, N_Vector jx);
  /// hx ← the derivative of J k in the direction x, k = Q fixed, by a difference: its error only slows
  /// Newton's method. `jk` is J k. Returns 0, or what a callback returned.
  int curvature(N_Vector x, N_Vector jk, N_Vector hx);

  SUNMatrix matrix() const { return matrix_.get(); }  ///< J of the last evaluate_matrix(); NULL without one
  double t() const { return t_; }                     ///< time of move_to()
  N_Vector v() const { return v_; }                   ///< state of move_to()
  N_Vector k() const { return k_; }                   ///< Q there
  refusal& refused() { return refused_; }             ///< by a callback

 private:
  int evaluate_matrix_at(N_Vector v, N_Vector k, SUNMatrix into);
  int product_at(N_Vector v, N_Vector k, SUNMatrix matrix, N_Vector x, N_Vector jx);
  int difference(N_Vector v, N_Vector x, N_Vector jx);
  double length(N_Vector x, double part);

  functions& of_;
  owned_matrix matrix_, moved_matrix_;
  nvector inverse_size_, moved_, moved_rate_, first_, second_, third_;  ///< the last three: work vectors
  double t_ = 0.0;
  N_Vector v_ = nullptr, k_ = nullptr;
  bool matrix_is_here_ = false, sizes_are_here_ = false;
  refusal refused_;
};

}  // namespace apsis::sundials
