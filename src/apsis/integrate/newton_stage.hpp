#pragma once

#include <apsis/integrate/autodiff.hpp>
#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/mass_matrix.hpp>
#include <apsis/integrate/simplified_newton.hpp>
#include <apsis/integrate/stage_preconditioner.hpp>

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// The stage of a newton_problem for Newton's method, with exact derivatives of G. With a mass matrix M,
/// g and its derivatives stay those of G, and rates are divided by M where they are needed.
template <class Real, class G>
struct newton_stage final : timed_stage_equation<Real> {
  /// Stores G.
  explicit newton_stage(G callable) : field(std::move(callable)) {}

  std::size_t size() const override { return explicit_part.size(); }
  /// Returns true if v is admissible, or without an admissible set.
  bool admissible(std::span<const Real> v) override { return !admissible_set || admissible_set(v); }
  stage_terms<Real> terms() const override { return {a, b, explicit_part}; }
  const mass_matrix<Real>* mass() const override { return mass_of_rates ? &*mass_of_rates : nullptr; }
  void rate(std::span<const Real> v, std::span<Real> out) override { field.value(v, out); }
  void rate_product(std::span<const Real> v, std::span<const Real> k, std::span<Real> jk) override {
    field.flow_product(v, k, jk);
  }
  bool has_preconditioner() const override { return static_cast<bool>(preconditioner); }
  void prepare_preconditioner(std::span<const Real> v, bool again) override {
    preconditioner.prepare(t, v, a, b, again);
  }
  void precondition(std::span<const Real> r, std::span<Real> x) override {
    preconditioner.divide(mass(), r, x);
  }
  Real size_of_correction(std::span<const Real> v, std::span<const Real> delta) override {
    return tolerances ? tolerances->of_change(v, delta) / share : std::numeric_limits<Real>::infinity();
  }
  void rate_curvature(std::span<const Real> v, std::span<const Real> k, std::span<const Real> x,
                      std::span<Real> jx, std::span<Real> hx) override {
    field.curvature(v, k, x, jx, hx);
  }

  void residual(std::span<const Real> v, std::span<Real> r) override {
    if (b != Real(0) && !mass_of_rates) {
      field.time_derivatives(v, g, g_dot);
    } else {
      field.value(v, g);
    }
    if (b != Real(0) && mass_of_rates) {
      moved = g;
      mass_of_rates->divide(moved);
      field.flow_product(v, moved, g_dot);
    }
    for (std::size_t i = 0; i < v.size(); ++i) r[i] = v[i] - explicit_part[i];
    if (mass_of_rates) {
      moved.assign(r.begin(), r.end());
      mass_of_rates->multiply(moved, r);
    }
    for (std::size_t i = 0; i < v.size(); ++i) {
      r[i] -= a * g[i];
      if (b != Real(0)) r[i] -= b * g_dot[i];
    }
  }

  void differential(std::span<const Real> v, std::span<const Real> x, std::span<Real> y,
                    std::span<Real> z) override {
    if (b == Real(0)) {
      field.jacobian_product(v, x, y);
    } else if (mass_of_rates) {
      second_product(v, x, y, z);
    } else {
      field.second_product(v, x, y, z);
    }
    for (std::size_t i = 0; i < v.size(); ++i) {
      y[i] *= -a;
      z[i] = b != Real(0) ? -b * z[i] : Real(0);
    }
  }

  void product_at(Real at, std::span<const Real> v, std::span<const Real> x, std::span<Real> jx) override {
    field.set_time(at, theta);
    field.jacobian_product(v, x, jx);
    field.set_time(t, theta);
  }

  /// Sets y ← G'(v) x and z ← Ġ'(v) x = G''(v)[k, x] + G'(v) M⁻¹ G'(v) x, k = M⁻¹ G(v).
  void second_product(std::span<const Real> v, std::span<const Real> x, std::span<Real> y,
                      std::span<Real> z) {
    moved.resize(v.size());
    field.value(v, moved);
    mass_of_rates->divide(moved);
    field.curvature(v, moved, x, y, z);
    moved.assign(y.begin(), y.end());
    mass_of_rates->divide(moved);
    bent.resize(v.size());
    field.jacobian_product(v, moved, bent);
    for (std::size_t i = 0; i < v.size(); ++i) z[i] += bent[i];
  }

  /// @cond
  field_of<Real, G> field;                                    ///< G and its derivatives
  Real t = Real(0), theta = Real(0);                          ///< set_time() of the stage
  std::function<bool(std::span<const Real>)> admissible_set;  ///< or none
  std::optional<component_tolerances<Real>> tolerances;       ///< of the step; none: solve to rounding
  stage_preconditioner<Real> preconditioner;                  ///< of Krylov solvers; or none
  std::optional<mass_matrix<Real>> mass_of_rates;             ///< M; none: 1
  Real share = Real(0);                                       ///< part of the tolerances that a stage may use
  Real a = Real(0), b = Real(0);                              ///< coefficients of the stage
  std::vector<Real> explicit_part,                            ///< u_e
      g, g_dot,                                               ///< work space for G and its derivative
      moved, bent;                                            ///< work space for rates
  /// @endcond
};

}  // namespace apsis
