#include "internal/jacobian.hpp"

#include <cmath>
#include <limits>
#include <new>

namespace apsis::sundials {
namespace {

constexpr double unit_rounding = std::numeric_limits<double>::epsilon();

}  // namespace

owned_matrix::owned_matrix(SUNMatrix like) : m_(SUNMatClone(like)) {
  if (m_ == nullptr) throw std::bad_alloc();
}

jacobian::jacobian(functions& of, const nvector& like)
    : of_(of),
      matrix_(of.matrix != nullptr ? owned_matrix(of.matrix) : owned_matrix()),
      moved_matrix_(of.matrix != nullptr ? owned_matrix(of.matrix) : owned_matrix()),
      inverse_size_(like.another()),
      moved_(like.another()),
      moved_rate_(like.another()),
      first_(like.another()),
      second_(like.another()),
      third_(like.another()) {}

int jacobian::move_to(double t, N_Vector v, N_Vector k) {
  t_ = t;
  v_ = v;
  k_ = k;
  matrix_is_here_ = sizes_are_here_ = false;
  if (of_.product == nullptr || of_.product_setup == nullptr) return 0;
  return refused_.keep("product_setup", of_.product_setup(t, v, k, of_.data));
}

int jacobian::evaluate_matrix_at(N_Vector v, N_Vector k, SUNMatrix into) {
  of_.count(APSIS_SUNDIALS_JACOBIANS);
  // Functions of sparse and banded matrices set only entries that are not 0.
  SUNMatZero(into);
  const int returned = of_.jacobian(t_, v, k, into, of_.data, first_.get(), second_.get(), third_.get());
  if (returned == 0) SUNMatMatvecSetup(into);
  return refused_.keep("jacobian", returned);
}

int jacobian::evaluate_matrix() {
  if (matrix_is_here_) return 0;
  const int returned = evaluate_matrix_at(v_, k_, matrix_.get());
  matrix_is_here_ = returned == 0;
  return returned;
}

int jacobian::product_at(N_Vector v, N_Vector k, SUNMatrix matrix, N_Vector x, N_Vector jx) {
  if (of_.product != nullptr) {
    of_.count(APSIS_SUNDIALS_PRODUCTS);
    return refused_.keep("product", of_.product(x, jx, t_, v, k, of_.data, first_.get()));
  }
  if (matrix == nullptr) return difference(v, x, jx);
  return SUNMatMatvec(matrix, x, jx);
}

int jacobian::product(N_Vector x, N_Vector jx) {
  if (of_.product == nullptr && of_.matrix != nullptr)
    if (const int returned = evaluate_matrix(); returned != 0) return returned;
  return product_at(v_, k_, matrix_.get(), x, jx);
}

int jacobian::curvature(N_Vector x, N_Vector jk, N_Vector hx) {
  // Products that are differences themselves have two thirds of the digits.
  const bool exact = of_.product != nullptr || of_.matrix != nullptr;
  const double part = std::sqrt(unit_rounding), h = length(x, exact ? part : std::sqrt(part));
  if (h == 0.0) {
    N_VConst(0.0, hx);
    return 0;
  }
  N_VLinearSum(1.0, v_, h, x, moved_.get());
  of_.count(APSIS_SUNDIALS_COLLISION_EVALUATIONS);
  int returned = refused_.keep("collision", of_.collision(t_, moved_.get(), moved_rate_.get(), of_.data));
  if (returned == 0 && of_.product == nullptr && of_.matrix != nullptr)
    returned = evaluate_matrix_at(moved_.get(), moved_rate_.get(), moved_matrix_.get());
  const bool prepared = of_.product != nullptr && of_.product_setup != nullptr;
  if (returned == 0 && prepared)
    returned =
        refused_.keep("product_setup", of_.product_setup(t_, moved_.get(), moved_rate_.get(), of_.data));
  if (returned == 0) returned = product_at(moved_.get(), moved_rate_.get(), moved_matrix_.get(), k_, hx);
  if (returned == 0 && prepared)
    returned = refused_.keep("product_setup", of_.product_setup(t_, v_, k_, of_.data));
  if (returned == 0) N_VLinearSum(1.0 / h, hx, -1.0 / h, jk, hx);
  return returned;
}

/// Returns the h with which hx changes no element of v by more than `part` of its size; 0 for x = 0. A size
/// is at least 1e-3 of the largest.
double jacobian::length(N_Vector x, double part) {
  if (!sizes_are_here_) {
    const double largest = N_VMaxNorm(v_);
    N_VAbs(v_, inverse_size_.get());
    N_VAddConst(inverse_size_.get(), 1e-3 * (largest > 0.0 ? largest : 1.0), inverse_size_.get());
    N_VInv(inverse_size_.get(), inverse_size_.get());
    sizes_are_here_ = true;
  }
  N_VProd(x, inverse_size_.get(), third_.get());
  const double size = N_VMaxNorm(third_.get());
  return size > 0.0 ? part / size : 0.0;
}

/// jx ← (Q(v + hx) − Q(v − hx))/(2h).
int jacobian::difference(N_Vector v, N_Vector x, N_Vector jx) {
  const double h = length(x, std::cbrt(unit_rounding));
  if (h == 0.0) {
    N_VConst(0.0, jx);
    return 0;
  }
  for (const double side : {1.0, -1.0}) {
    N_VLinearSum(1.0, v, side * h, x, first_.get());
    of_.count(APSIS_SUNDIALS_COLLISION_EVALUATIONS);
    const int returned = of_.collision(t_, first_.get(), second_.get(), of_.data);
    if (returned != 0) return refused_.keep("collision", returned);
    if (side > 0.0)
      N_VScale(1.0 / (2.0 * h), second_.get(), jx);
    else
      N_VLinearSum(1.0, jx, -1.0 / (2.0 * h), second_.get(), jx);
  }
  return 0;
}

}  // namespace apsis::sundials
