#pragma once

#include <apsis/integrate/autodiff.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// Derivatives by central differences (`differentiated`), for a g(u, out) or g(t, u, out) that accepts
/// numbers of type Real only. A product G'(u) x has about two thirds of the digits of Real and takes two
/// calls of g. It enters Ġ = G'G and thus the solution. For G much faster than a step, choose a method
/// without second derivatives, such as extrapolated-euler-S: there errors of differences only slow Newton's
/// method. Differences change unknown i by small parts of max(|u_i|, 1e-6 max|u|), and t by such parts of
/// max(|t|, time_scale).
template <class G, class Real = double>
class difference_derivatives {
 public:
  /// Stores g as above. time_scale > 0 is a time in which G changes little; it is used for t closer to 0 than
  /// time_scale.
  explicit difference_derivatives(G g, Real time_scale = Real(1))
      : g_(std::move(g)), time_scale_(time_scale) {}

  /// Sets the time of all evaluations that follow.
  void set_time(Real t)
    requires function_of_time<G, Real>
  {
    t_ = t;
  }

  /// out ← G(u).
  void value(std::span<const Real> u, std::span<Real> out) { evaluate(t_, u, out); }

  /// jx ← (G(u + hx) − G(u − hx))/(2h).
  void jacobian_product(std::span<const Real> u, std::span<const Real> x, std::span<Real> jx) {
    const Real h = length(u, x, std::cbrt(rounding));
    resize(u.size());
    std::fill(jx.begin(), jx.end(), Real(0));
    for (const Real side : {Real(1), Real(-1)}) {
      for (std::size_t i = 0; i < u.size(); ++i) at_[i] = u[i] + side * h * x[i];
      add(side / (Real(2) * h), jx);
    }
  }

  /// hx ← the second difference of G in the directions k and x.
  void curvature(std::span<const Real> u, std::span<const Real> k, std::span<const Real> x,
                 std::span<Real> hx) {
    const Real part = std::sqrt(std::sqrt(rounding)), of_k = length(u, k, part), of_x = length(u, x, part);
    resize(u.size());
    std::fill(hx.begin(), hx.end(), Real(0));
    for (const Real first : {Real(1), Real(-1)})
      for (const Real second : {Real(1), Real(-1)}) {
        for (std::size_t i = 0; i < u.size(); ++i) at_[i] = u[i] + first * of_k * k[i] + second * of_x * x[i];
        add(first * second / (Real(4) * of_k * of_x), hx);
      }
  }

  /// out ← ∂G/∂t.
  void time_derivative(std::span<const Real> u, std::span<Real> out)
    requires function_of_time<G, Real>
  {
    const Real h = std::cbrt(rounding) * std::max(std::abs(t_), time_scale_), now = t_;
    resize(u.size());
    std::copy(u.begin(), u.end(), at_.begin());
    std::fill(out.begin(), out.end(), Real(0));
    for (const Real side : {Real(1), Real(-1)}) {
      t_ = now + side * h;
      add(side / (Real(2) * h), out);
    }
    t_ = now;
  }

 private:
  static constexpr Real rounding = std::numeric_limits<Real>::epsilon();

  void evaluate(Real t, std::span<const Real> u, std::span<Real> out) {
    if constexpr (function_of_time<G, Real>)
      g_(t, u, out);
    else
      g_(u, out);
  }

  void resize(std::size_t n) {
    at_.resize(n);
    value_.resize(n);
  }

  /// sum ← sum + weight G(at_).
  void add(Real weight, std::span<Real> sum) {
    evaluate(t_, at_, value_);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * value_[i];
  }

  /// Returns the h with which hx changes no unknown by more than `part` of its size; 1 for x = 0.
  static Real length(std::span<const Real> u, std::span<const Real> x, Real part) {
    Real largest(0), h = std::numeric_limits<Real>::infinity();
    for (const Real value : u) largest = std::max(largest, std::abs(value));
    if (!(largest > Real(0))) largest = Real(1);
    for (std::size_t i = 0; i < u.size(); ++i)
      if (x[i] != Real(0))
        h = std::min(h, part * std::max(std::abs(u[i]), Real(1e-6) * largest) / std::abs(x[i]));
    return h < std::numeric_limits<Real>::infinity() && h > Real(0) ? h : Real(1);
  }

  G g_;
  Real time_scale_, t_ = Real(0);
  std::vector<Real> at_, value_;
};

}  // namespace apsis
