#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/guarded_newton.hpp>
#include <apsis/integrate/mass_matrix.hpp>

#include <cstddef>
#include <functional>
#include <limits>
#include <span>

#include <Eigen/Dense>
#include <fmt/format.h>

namespace apsis::detail {

template <class Real>
using column = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

template <class Real>
std::span<Real> as_span(column<Real>& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}
template <class Real>
std::span<const Real> as_span(const column<Real>& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

template <class Real>
column<Real> masses(const stage_equation<Real>& equation, const column<Real>& x) {
  if (equation.mass() == nullptr) return x;
  column<Real> y(x.size());
  equation.mass()->multiply(as_span(x), as_span(y));
  return y;
}

template <class Real>
constexpr Real singular_below = Real(45) * std::numeric_limits<Real>::epsilon();

/// Maximum norm: the squares in a Euclidean norm of a decayed solution would underflow.
template <class Real>
Real largest(const column<Real>& x) {
  return x.template lpNorm<Eigen::Infinity>();
}

inline constexpr const char* advice =
    "change the time step, use a method with d > 0 at every stage, or relaxation_problem";

[[noreturn]] inline void fail_singular(int iteration, double measure) {
  throw numerical_error(
      fmt::format("the stage equation is singular to working precision (relative smallest singular value "
                  "{:.2g} at Newton iteration {}; a stage with d = 0 is singular where Δt λ = ±i/√|ḋ| for an "
                  "eigenvalue λ of G'); {}",
                  measure, iteration, advice));
}

/// A Newton step, and the size of R(v) due to rounding alone.
template <class Real>
struct newton_step {
  column<Real> delta;
  Real noise;
  Real stiffness;  ///< stiffness_of() the terms of R'; above stiffest() there is no step
  std::function<column<Real>(const column<Real>&)> correct;  ///< r ↦ −R'(v)⁻¹ r; empty if not available
};

}  // namespace apsis::detail
