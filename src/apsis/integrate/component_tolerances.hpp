#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/array_state.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {

/// Relative and absolute tolerances of the unknowns u_i. The error of every unknown is compared with its own
/// tolerance:
///   τ_i(u) = rtol_i |u_i| + atol_i.
/// An object of this class is the distance of error control, with 1 as the tolerance of the controller:
///   distance(u, v) = max_i |u_i − v_i| / (rtol_i max(|u_i|, |v_i|) + atol_i).
/// No unknown then has an estimated error above its own tolerance. The controller is step_controller
/// control(1.0, order). rtol is dimensionless, atol_i has the unit of u_i.
template <class Real>
class component_tolerances {
 public:
  /// The same tolerances for all unknowns. Throws input_error like the other constructor.
  component_tolerances(Real relative, Real absolute)
      : component_tolerances(std::vector<Real>{relative}, std::vector<Real>{absolute}) {}

  /// Each list has one number, for all unknowns, or one for every unknown. Throws input_error if a list is
  /// empty, a number is negative or not finite, or both tolerances of an unknown are 0. Throws it also if the
  /// lists have different lengths above one.
  component_tolerances(std::vector<Real> relatives, std::vector<Real> absolutes)
      : relative_(std::move(relatives)), absolute_(std::move(absolutes)) {
    const std::size_t n = std::max(relative_.size(), absolute_.size());
    if (relative_.empty() || absolute_.empty())
      throw input_error(
          "there is no tolerance (the list is empty); give one number, or one for each unknown");
    if ((relative_.size() != n && relative_.size() != 1) || (absolute_.size() != n && absolute_.size() != 1))
      throw input_error(fmt::format(
          "{} relative and {} absolute tolerances do not fit (one of each belongs to an unknown); "
          "give one number, or one for each unknown",
          relative_.size(), absolute_.size()));
    for (std::size_t i = 0; i < n; ++i) {
      const Real r = relative(i), a = absolute(i);
      if (!(r >= Real(0) && a >= Real(0) && r + a < std::numeric_limits<Real>::infinity()))
        throw input_error(fmt::format(
            "a tolerance of unknown {} is negative or not finite (rtol {:g}, atol {:g}); give numbers ≥ 0", i,
            static_cast<double>(r), static_cast<double>(a)));
      if (r == Real(0) && a == Real(0))
        throw input_error(
            fmt::format("unknown {} has no tolerance (rtol and atol are 0); give one of them above 0", i));
    }
  }

  /// rtol_i.
  Real relative(std::size_t i) const { return relative_[relative_.size() == 1 ? 0 : i]; }
  /// atol_i.
  Real absolute(std::size_t i) const { return absolute_[absolute_.size() == 1 ? 0 : i]; }

  /// Returns the distance of u and v as above; +infinity or NaN if one of them contains such a number. A
  /// ratio 0/0 counts as 0. Throws input_error if u has another number of unknowns than the tolerances.
  template <array_state State>
  Real operator()(const State& u, const State& v) const {
    using size_type = decltype(u.size());
    require_length(static_cast<std::size_t>(u.size()));
    Real largest(0);
    for (size_type k = 0; k < u.size(); ++k) {
      const Real ratio = in_tolerances(static_cast<std::size_t>(k), Real(u[k] - v[k]),
                                       std::max(std::abs(Real(u[k])), std::abs(Real(v[k]))));
      if (!(ratio <= largest)) largest = ratio;
      if (std::isnan(ratio)) return ratio;
    }
    return largest;
  }

  /// Returns max_i |δ_i|/τ_i(v) for a change δ of v. Throws like the distance.
  Real of_change(std::span<const Real> v, std::span<const Real> delta) const {
    require_length(v.size());
    Real largest(0);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Real ratio = in_tolerances(i, delta[i], std::abs(v[i]));
      if (!(ratio <= largest)) largest = ratio;
      if (std::isnan(ratio)) return ratio;
    }
    return largest;
  }

 private:
  Real in_tolerances(std::size_t i, Real difference, Real size) const {
    const Real of = std::abs(difference);
    return of == Real(0) ? of : of / (relative(i) * size + absolute(i));
  }

  void require_length(std::size_t n) const {
    const std::size_t given = std::max(relative_.size(), absolute_.size());
    if (given != 1 && given != n)
      throw input_error(
          fmt::format("there are {} tolerances and {} unknowns (they differ in number); give one "
                      "number, or one for each unknown",
                      given, n));
  }

  std::vector<Real> relative_, absolute_;
};

}  // namespace apsis
