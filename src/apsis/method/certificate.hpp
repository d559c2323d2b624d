#pragma once

#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/precision.hpp>

#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// An order condition that a method violates.
struct failed_condition {
  std::string tree;  ///< "G[F]"
  int order = 0;     ///< order of the tree: one above the order of the method
  mp_real value,     ///< φ(τ), left-hand side
      wanted;        ///< 1/γ(τ)
};

/// Linear stability of the implicit part, y' = λy: R(z) = e_s·(I − zA − z²Ȧ)⁻¹e, z = λΔt.
struct implicit_stability {
  std::vector<double> imaginary_poles;   ///< 1/√|ḋ| of stages with d = 0: poles at ±i times this value
  double largest_on_negative_axis = 0;   ///< sup |R(x)|, x < 0
  double smallest_on_negative_axis = 0;  ///< inf R(x), x < 0; ≥ 0 means no sign change
  double at_infinity = 0;                ///< |R(−∞)|
  double angle = 0;                      ///< α of A(α) in degrees: |R| ≤ 1 on the sector |arg(−z)| ≤ α
  bool l_stable = false;                 ///< A-stable and R(−∞) = 0
};

/// Certificate of an embedded solution ũ, the last row of with_embedded_row().
struct embedded_certificate {
  int order = 0;           ///< q, by the order conditions of all rows
  int conditions = 0;      ///< number of conditions up to order q
  mp_real order_residual;  ///< largest residual of these conditions
  mp_real estimate;      ///< 2-norm of φ̃(τ) − 1/γ(τ) over all trees τ of order q + 1: the size of u^{n+1} − ũ
  mp_real alignment;     ///< |cosine| of the angle between these residuals and 1/γ(τ): 1 if u^{n+1} − ũ is a
                         ///< multiple of the Taylor term of order q + 1
  bool relaxes = false;  ///< has an implicit part, so that ε → 0 projects ũ to equilibrium
  std::optional<mp_real> last;   ///< its O(ε) term relative to the exact one (intermediate_regime::last)
  int explicit_evaluations = 0;  ///< additional evaluations of T, at stages where u^{n+1} needs none
  int implicit_solves = 0;       ///< additional stage solves: 0 or 1
  /// Factor W of the estimated error of a step: max(1, C/(18 a C̃)) if q = p − 1, else 1. C is the error
  /// constant of the method, C̃ the estimate and a its alignment, at least 0.1. For q = p − 1, errors of u and
  /// estimates are both of size Δt^p. After a time of order one the error is about C/(aC̃) times the
  /// estimates.
  double weight = 1.0;
};

/// Certificate of a method: its properties, derived from the coefficients alone.
struct certificate {
  static constexpr int highest_order = 8;  ///< largest order that is certified; 4 with exact collisions

  std::string name;                      ///< name of the method
  method_kind kind = method_kind::imex;  ///< determines which order conditions apply
  int order = 0;                         ///< order p by the order conditions, at most the largest that is
                                         ///< certified
  mp_real order_residual;                ///< largest residual of the conditions up to `order`
  std::vector<failed_condition> next;    ///< violated conditions of order p + 1
  int conditions = 0;                    ///< number of conditions up to order p
  mp_real error_constant;                ///< 2-norm of φ(τ) − 1/γ(τ) over all trees τ of order p + 1; NaN if
                                         ///< these are not evaluated

  bool unconditional = false;           ///< SSP without a step bound from Q
  bool bounded = true;                  ///< the explicit part sets a bound Δt ≤ r Δt_FE
  mp_real ssp_coefficient = 0;          ///< r from the Butcher form; with exact collisions, from the
                                        ///< Shu–Osher form. Undefined if !bounded
  mp_real radius_of_implicit_part = 0;  ///< radius of absolute monotonicity of A: relevant where Q satisfies
                                        ///< a forward Euler condition
  mp_real explicit_radius = 0;          ///< radius of absolute monotonicity of Â: SSP coefficient of the
                                        ///< explicit part alone
  std::string limiting_entry;           ///< entry that limits r, or rules out every r > 0

  std::string type;              ///< "A", "ARS", "CK", "explicit" or "none"; a final update does not count
                                 ///< as a stage
  bool gsa = true;               ///< globally stiffly accurate: u^{n+1} = u_s rather than an explicit update
  bool ap = false;               ///< asymptotic preserving for any initial data
  std::string ap_data;           ///< "any data", "consistent data" or "none"; with "(moments only)" if not
                                 ///< GSA, because u^{n+1} is then not projected to equilibrium
  int explicit_evaluations = 0;  ///< of T per step, n_F
  int implicit_solves = 0;       ///< stages with d_i ≠ 0 or ḋ_i ≠ 0
  implicit_stability stability;  ///< default values for methods without stage solves

  // O(ε) terms for ε ≪ Δt (docs/plateaus.md); IMEX methods only.
  intermediate_regime<mp_real> regime;  ///< coefficients of these terms; undefined if !regime.applies
  intermediate_band band;               ///< error where ε ~ Δt
  bool keeps_slow_terms = false;  ///< (N1), (N2): exact for data near equilibrium; for BGK, the viscosity
  bool keeps_layer = false;       ///< (N3): the integral over an initial layer is exact, too
  /// Returns "all" if both flags are set, "slow" if only keeps_slow_terms is, otherwise "none".
  std::string remaining_terms() const;

  std::optional<embedded_certificate> embedded;  ///< present for methods with an embedded row

  bool claims_hold = false;           ///< whether `failures` is empty
  std::vector<std::string> failures;  ///< one line per failed claim: condition, value, tree
};

/// Which properties certify() derives.
enum class certificate_scope {
  all,    ///< all
  claims  ///< those that a method may claim, and those of its embedded row: without stability that is not
          ///< claimed, and without the band where ε ~ Δt
};

/// Certifies a method in arithmetic of 60 digits. Tolerance: 10^{3−n} for coefficients of n decimals, 1e-50
/// for exact ones. A claim that does not hold is an entry of `failures`.
certificate certify(const method& m, certificate_scope scope = certificate_scope::all);

/// Returns the certificate of the method called `name`; a method file that has changed is certified again.
/// Throws like find_method(), except for claims that do not hold: the certificate lists them.
const certificate& find_certificate(const std::string& name);

/// Throws a claim_error that lists the failures of `c`, if there are any.
void require_claims(const certificate& c);

}  // namespace apsis
