#include "internal/block_field.hpp"

#include <apsis/integrate/array_state.hpp>

#include <algorithm>
#include <cmath>

namespace apsis::c {
namespace {

double largest(std::span<const double> x) {
  double found = 0.0;
  for (const double one : x) found = std::max(found, std::abs(one));
  return found;
}

}  // namespace

void known_jacobian::product(callbacks& of, const stage_position& now, std::span<const double> u,
                             std::span<const double> x, std::span<double> jx) {
  const std::size_t n = u.size();
  if (of.jacobian == nullptr) return std::fill(jx.begin(), jx.end(), 0.0);  // Q = 0
  if (now.solve != solve_ || !std::equal(u.begin(), u.end(), at_.begin(), at_.end())) {
    at_.clear();  // until the matrix is known
    matrix_.resize(n * n);
    of.count(APSIS_JACOBIAN_EVALUATIONS);
    require_success("jacobian", of.jacobian(now.block, n, u.data(), matrix_.data(), of.data));
    require_finite(matrix_, "the result of the callback 'jacobian'");
    at_.assign(u.begin(), u.end());
    solve_ = now.solve;
  }
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < n; ++j) sum += matrix_[i * n + j] * x[j];
    jx[i] = sum;
  }
}

void block_rate::operator()(double t, std::span<const double> u, std::span<double> q) const {
  try {
    of->evaluate_block(t, now->block, u, q);
  } catch (const numerical_error&) {
    // A stage may still be solved with the derivative at another state.
    std::fill(q.begin(), q.end(), std::nan(""));
  }
}

void block_field::product(known_jacobian& known, std::span<const double> u, std::span<const double> x,
                          std::span<double> jx) {
  if (of_->is_differenced()) return differences_.jacobian_product(u, x, jx);
  if (of_->timed_product == nullptr && of_->product == nullptr) return known.product(*of_, *now_, u, x, jx);
  of_->count(APSIS_PRODUCT_EVALUATIONS);
  const std::size_t n = u.size();
  require_success("product",
                  of_->timed_product != nullptr
                      ? of_->timed_product(t_, now_->block, n, u.data(), x.data(), jx.data(), of_->data)
                      : of_->product(now_->block, n, u.data(), x.data(), jx.data(), of_->data));
}

void block_field::time_derivative(std::span<const double> u, std::span<double> out) {
  std::fill(out.begin(), out.end(), 0.0);
  if (of_->timed_rate == nullptr) return;
  // The cube root of the rounding unit balances rounding and truncation. Rounding errors of t limit it, too.
  const double h = std::max(6e-6 * now_->step, 1e-10 * std::abs(t_));
  other_.resize(u.size());
  for (const double side : {1.0, -1.0}) {
    of_->evaluate_block(t_ + side * h, now_->block, u, other_);
    for (std::size_t i = 0; i < u.size(); ++i) out[i] += side * other_[i] / (2.0 * h);
  }
}

void block_field::curvature(std::span<const double> u, std::span<const double> k, std::span<const double> x,
                            std::span<double> hx) {
  if (of_->curvature != nullptr)
    return require_success("curvature", of_->curvature(now_->block, u.size(), u.data(), k.data(), x.data(),
                                                       hx.data(), of_->data));
  if (of_->is_differenced()) return differences_.curvature(u, k, x, hx);
  std::fill(hx.begin(), hx.end(), 0.0);
  const double along = largest(k);
  if (!(along > 0.0)) return;
  // The cube root of the rounding unit balances rounding and truncation.
  const double size = largest(u), h = 6e-6 * (size > 0.0 ? size : 1.0) / along;
  const std::size_t n = u.size();
  moved_.resize(n);
  other_.resize(n);
  for (std::size_t i = 0; i < n; ++i) moved_[i] = u[i] + h * k[i];
  product(after_, moved_, x, hx);
  for (std::size_t i = 0; i < n; ++i) moved_[i] = u[i] - h * k[i];
  product(before_, moved_, x, other_);
  for (std::size_t i = 0; i < n; ++i) hx[i] = (hx[i] - other_[i]) / (2.0 * h);
}

}  // namespace apsis::c
