#pragma once

#include <apsis/design/conditions.hpp>
#include <apsis/design/tangent.hpp>

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace apsis {

/// Zero pattern of a method: which coefficients may be nonzero.
struct zero_pattern {
  method_kind kind = method_kind::imex;  ///< class of equations
  matrix<char> P,                        ///< whether p_ij may be nonzero; s × s, strictly lower triangular
      W;                                 ///< whether w_ij may be nonzero; s × s, strictly lower triangular
  std::vector<char> d,                   ///< whether d_i may be nonzero
      ddot;                              ///< whether ḋ_i may be nonzero
  std::vector<char> initial;             ///< whether r_i may be nonzero; r_1 = 1 always
  int steps = 1;                         ///< 2: the first row stands for u^{n−1}, with d = ḋ = 0
  /// Returns the number s of stages.
  std::size_t stages() const { return d.size(); }
  /// Returns which stages have a T that enters a later stage.
  std::vector<char> transport() const;
};

/// Returns the pattern with all coefficients free, where T is evaluated only at the stages in `transport`.
zero_pattern full_pattern(method_kind kind, const std::vector<char>& transport, int steps = 1);

/// Requirements on a method in addition to its pattern.
struct design_demands {
  int order = 2;                               ///< order p
  double box = 2.0;                            ///< d_i ≤ box, |ḋ_i| ≤ box
  double margin = 1e-3;                        ///< d_i + |ḋ_i| ≥ margin: type A
  double least_r = 0.01;                       ///< r ≥ least_r (methods with transport)
  double largest_r = 64.0;                     ///< r ≤ largest_r
  regime_demand regime = regime_demand::none;  ///< conditions on the O(ε) terms for ε ≪ Δt
  double least_angle = 0.0;                    ///< α of A(α)-stability of the implicit part, in degrees
  double least_pole = 0.0;                     ///< lower bound of 1/√|ḋ| for stages with d = 0, whose
                                               ///< poles are ±i/√|ḋ|
  int most_buffers = 1000;  ///< upper bound of state-sized buffers of a step; checked after the search
  /// Prescribed first rows, together with r: only later rows are unknown.
  std::optional<shu_osher_form<double>> given_rows;
  /// Returns the angle of the ray on which |R| ≤ 1 is imposed at discrete points. It is 5 % closer to 90
  /// degrees than `least_angle`, so that |R| ≤ 1 also holds between the points on the ray at `least_angle`.
  double aimed_angle() const;
  /// Returns the upper bound of |ḋ| of a stage with or without d.
  double largest_ddot(bool with_d) const;
};

/// Unknown coefficients of a method with their equations and bounds:
///   x = (p_ij, w_ij, r_i, d_i, ḋ_i, r), lower ≤ x ≤ upper,
///   order conditions (and those of the intermediate regime) = 0,    r_i + Σ_j (p_ij + w_ij) = 1,
///   d_i − ḋ_i ≥ margin,    |R|² − 1 ≤ 0 on a ray if an angle is required.
/// Derivatives are exact: gradients by a reverse sweep, second derivatives by a reverse sweep over `tangent`.
/// Objects have their own work space; use one per thread. Dimensionless.
class design_problem {
 public:
  /// Sets up unknowns, bounds and equations of a pattern. `demands.given_rows` must not have more rows
  /// than the pattern.
  design_problem(zero_pattern pattern, const design_demands& demands);

  const zero_pattern& pattern() const { return pattern_; }    ///< pattern of the unknowns
  const design_demands& demands() const { return demands_; }  ///< requirements
  const Eigen::VectorXd& lower() const { return lower_; }     ///< x ≥ lower
  const Eigen::VectorXd& upper() const { return upper_; }     ///< x ≤ upper; equals lower() in given rows
  Eigen::Index unknowns() const { return lower_.size(); }     ///< length of x
  /// Returns the number of equations: order and other conditions, followed by row sums.
  Eigen::Index equations() const {
    return static_cast<Eigen::Index>(conditions_.first.size() + rows_.size());
  }
  /// Returns the name of equation k: a tree, "flux = 1", "weights of stage 3".
  const std::string& equation_name(Eigen::Index k) const { return names_[static_cast<std::size_t>(k)]; }
  /// Returns for every row the indices of its weights, whose sum is 1.
  const std::vector<std::vector<Eigen::Index>>& rows() const { return rows_; }
  /// Returns the equations without the row sums, to be evaluated in `Real`: double or mp_real.
  template <class Real>
  condition_sweep<Real> sweep() const;
  /// Returns the index of r in x; −1 for methods without transport.
  Eigen::Index place_of_r() const { return r_place_; }

  /// Linear inequality Σ a_k x_k ≥ least.
  struct inequality {
    std::vector<std::pair<Eigen::Index, double>> terms;  ///< pairs (k, a_k)
    double least;                                        ///< lower bound
  };
  /// Returns d_i − ḋ_i ≥ margin for stages where both are unknown; for other stages it is a bound.
  const std::vector<inequality>& inequalities() const { return inequalities_; }

  /// Returns the method with these unknowns; r = 1 if r is not an unknown.
  shu_osher_form<double> form(const Eigen::VectorXd& x) const;
  /// Returns the method with these unknowns in `Real`: double, tangent or mp_real.
  template <class Real>
  shu_osher_form<Real> form_of(const std::vector<Real>& x) const;
  /// Returns the unknowns of a method with the same number of stages; coefficients outside the
  /// pattern are dropped.
  Eigen::VectorXd unknowns_of(const shu_osher_form<double>& m) const;

  /// Returns left-hand minus right-hand sides of all equations().
  Eigen::VectorXd residuals(const Eigen::VectorXd& x);
  /// Returns the Jacobian of residuals(), equations() × unknowns().
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& x);

  /// Returns the number of stability limits, values that must be ≤ 0; 0 if no angle is required.
  Eigen::Index limits() const { return limits_ ? static_cast<Eigen::Index>(limits_->first.size()) : 0; }
  /// Returns the values of stability_limits() at x; empty if no angle is required.
  Eigen::VectorXd limit_values(const Eigen::VectorXd& x);
  /// Returns the Jacobian of limit_values(), limits() × unknowns().
  Eigen::MatrixXd limit_jacobian(const Eigen::VectorXd& x);

  /// Error measures that can be minimized.
  enum class measure {
    error,  ///< residuals of the next order, error_terms()
    band,   ///< residuals of band_terms()
    layer   ///< residuals of layer_terms()
  };
  /// Returns ½ Σ residuals², and optionally its gradient.
  double half_square(measure what, const Eigen::VectorXd& x, Eigen::VectorXd* gradient = nullptr);

  /// Weights of the terms of the Lagrangian.
  struct weights {
    Eigen::VectorXd equations,  ///< λ_k
        limits;                 ///< μ_l
    double error = 0.0,         ///< factor of half_square(measure::error, x)
        band = 0.0,             ///< factor of half_square(measure::band, x)
        layer = 0.0;            ///< factor of half_square(measure::layer, x)
  };
  /// Returns the Hessian of Σ_k λ_k residual_k + Σ_l μ_l limit_l + the weighted half squares,
  /// unknowns() × unknowns().
  Eigen::MatrixXd hessian(const Eigen::VectorXd& x, const weights& given);

 private:
  enum class part { P, W, initial, d, ddot, r };
  struct unknown {
    part what;
    std::size_t i, j;
  };
  /// Returns the entry of an unknown in a form; nullptr for r_i, which a form does not store.
  template <class Real>
  static Real* entry(shu_osher_form<Real>& m, const unknown& u);
  template <class Real>
  shu_osher_form<Real> empty_form() const;
  /// Sweeps for values and gradients, and for second derivatives.
  struct sweeps {
    sweeps(const condition_list& list, const std::vector<char>& slow, int steps)
        : first(list, slow, steps), second(list, slow, steps) {}
    condition_sweep<double> first;
    condition_sweep<tangent> second;
  };
  sweeps& terms_of(measure what);
  Eigen::VectorXd gradient_of(condition_sweep<double>& seeded) const;
  Eigen::MatrixXd gradients_of(condition_sweep<double>& sweep, Eigen::Index rows) const;

  zero_pattern pattern_;
  design_demands demands_;
  std::vector<char> slow_;
  std::vector<unknown> unknowns_;
  Eigen::VectorXd lower_, upper_;
  Eigen::Index r_place_ = -1;
  std::vector<std::vector<Eigen::Index>> rows_;
  std::vector<std::string> names_;
  std::vector<inequality> inequalities_;
  sweeps conditions_;
  std::optional<sweeps> limits_, error_, band_, layer_;
};

}  // namespace apsis
