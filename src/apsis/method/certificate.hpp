#pragma once

#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/precision.hpp>

#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// An order condition that does not hold.
struct failed_condition {
  std::string tree;  ///< "G[F]"
  int order = 0;     ///< for which it is needed: the first that the method does not have
  mp_real value,     ///< φ(τ), left-hand side
      wanted;        ///< 1/γ(τ)
};

/// Linear stability of the implicit part, y' = λy: R(z) = e_s·(I − zA − z²Ȧ)⁻¹e, z = λΔt.
struct implicit_stability {
  std::vector<double> imaginary_poles;   ///< 1/√|ḋ| of stages with d = 0: poles at ± i times this
  double largest_on_negative_axis = 0;   ///< sup |R(x)|, x < 0
  double smallest_on_negative_axis = 0;  ///< inf R(x), x < 0; ≥ 0 means no sign change
  double at_infinity = 0;                ///< |R(−∞)|
  double angle = 0;                      ///< α of A(α) in degrees: |R| ≤ 1 on the sector |arg(−z)| ≤ α
  bool l_stable = false;                 ///< A-stable and R(−∞) = 0
};

/// What can be said of an embedded solution ũ, the last row of with_embedded_row().
struct embedded_certificate {
  int order = 0;           ///< q, by the order conditions of all rows
  int conditions = 0;      ///< number of conditions up to it
  mp_real order_residual;  ///< largest residual of them
  mp_real estimate;      ///< 2-norm of φ̃(τ) − 1/γ(τ) over all trees τ of order q + 1: the size of u^{n+1} − ũ
  mp_real alignment;     ///< cosine between these residuals and 1/γ(τ), without sign: 1 if u^{n+1} − ũ is a
                         ///< multiple of the Taylor term of order q + 1
  bool relaxes = false;  ///< it has an implicit part, so that ε → 0 projects it to equilibrium
  std::optional<mp_real> last;   ///< its term of size ε in parts of the exact one (intermediate_regime::last)
  int explicit_evaluations = 0;  ///< of T at stages where u^{n+1} needs none
  int implicit_solves = 0;       ///< 0 or 1
};

/// All that can be said of a method from its coefficients alone.
struct certificate {
  std::string name;                      ///< of the method
  method_kind kind = method_kind::imex;  ///< says which order conditions count
  int order = 0;                         ///< by the order conditions; 6 is the highest that is looked for
  mp_real order_residual;                ///< largest residual of the conditions up to `order`
  std::vector<failed_condition> next;    ///< conditions of order + 1 that fail
  int conditions = 0;                    ///< number of conditions up to `order`
  mp_real error_constant;                ///< 2-norm of φ(τ) − 1/γ(τ) over all trees τ of order + 1

  bool unconditional = false;   ///< SSP without a bound from Q
  bool bounded = true;          ///< the explicit part sets a bound Δt ≤ r Δt_FE
  mp_real ssp_coefficient = 0;  ///< r, from the Butcher form alone; of no meaning if !bounded
  mp_real radius_of_implicit_part =
      0;                        ///< classical radius of A, where Q satisfies a forward Euler condition
  mp_real explicit_radius = 0;  ///< classical radius of Â: the SSP coefficient of the explicit part by itself
  std::string limiting_entry;   ///< what forbids a larger r, or any

  std::string type;              ///< "A", "ARS", "CK", "explicit" or "none"; an update is no stage
  bool gsa = true;               ///< u^{n+1} = u_s, not an update without implicit part
  bool ap = false;               ///< asymptotic preserving for any initial data
  std::string ap_data;           ///< "any data", "consistent data" or "none"; "(moments only)" without GSA:
                                 ///< then u^{n+1} itself is not projected to equilibrium
  int explicit_evaluations = 0;  ///< of T per step, n_F
  int implicit_solves = 0;       ///< stages with d_i ≠ 0 or ḋ_i ≠ 0
  implicit_stability stability;  ///< not for explicit methods

  // Terms of size ε for ε ≪ Δt (docs/plateaus.md); of IMEX methods only.
  intermediate_regime<mp_real> regime;  ///< the numbers; of no meaning if !regime.applies
  intermediate_band band;               ///< where ε ~ Δt
  bool keeps_slow_terms = false;  ///< (N1), (N2): right for data near equilibrium; for BGK the viscosity
  bool keeps_layer = false;       ///< (N3): the integral of an initial layer too
  /// "all" if it keeps both, "slow", or "none".
  std::string keeps() const;

  std::optional<embedded_certificate> embedded;  ///< of methods that have such a row

  bool claims_hold = false;           ///< there are no failures
  std::vector<std::string> failures;  ///< condition, its value and its tree
};

/// Certifies a method in 60 digits (numerical tolerance: that of its digits).
certificate certify(const method& m);

/// The certificate of a method by its name, of a changed file a new one. Throws as find_method, but returns
/// the certificate of a method whose claims do not hold.
const certificate& find_certificate(const std::string& name);

/// Throws claim_error that lists the failures, if there are any.
void require_claims(const certificate& c);

}  // namespace apsis
