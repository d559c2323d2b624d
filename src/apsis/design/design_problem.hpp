#pragma once

#include <apsis/design/conditions.hpp>
#include <apsis/design/tangent.hpp>

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace apsis {

/// Which coefficients of a method may differ from zero.
struct zero_pattern {
  method_kind kind = method_kind::imex;  ///< which of T and Q the method has
  matrix<char> P,                        ///< whether p_ij may; s × s, strictly lower triangular
      W;                                 ///< whether w_ij may; s × s, strictly lower triangular
  std::vector<char> d,                   ///< whether d_i may
      ddot;                              ///< whether ḋ_i may
  std::vector<char> initial;             ///< whether r_i may differ from zero; r_1 = 1 always
  /// Number of stages, s.
  std::size_t stages() const { return d.size(); }
  /// Stages whose T enters a later one.
  std::vector<char> transport() const;
};

/// All coefficients free; T is evaluated at the stages in `transport` only.
zero_pattern full_pattern(method_kind kind, const std::vector<char>& transport);

/// What is asked of a method besides its pattern.
struct design_demands {
  int order = 2;                               ///< order p
  double box = 2.0;                            ///< d_i ≤ box, |ḋ_i| ≤ box
  double margin = 1e-3;                        ///< d_i + |ḋ_i| ≥ margin: type A
  double least_r = 0.01;                       ///< r ≥ least_r (methods with transport)
  double largest_r = 64.0;                     ///< r ≤ largest_r
  regime_demand regime = regime_demand::none;  ///< what is demanded of terms of size ε where ε ≪ Δt
  double least_angle = 0.0;                    ///< α of A(α)-stability of the implicit part, in degrees
  double least_pole = 0.0;                     ///< poles of stages with d = 0 are at ±i/√|ḋ|: 1/√|ḋ| at least
  int most_buffers = 1000;  ///< state-sized buffers of a step; looked at once a method is found
  /// Rows that are given, the first ones, and r with them: only later rows are unknown.
  std::optional<shu_osher_form<double>> given_rows;
  /// Where |R| ≤ 1 is asked for at some points, so that it holds between them on the ray of `least_angle`.
  double aimed_angle() const;
  /// Largest |ḋ| of a stage with or without d.
  double largest_ddot(bool with_d) const;
};

/// The unknown coefficients of a method with the equations and bounds that they must satisfy:
///   x = (p_ij, w_ij, r_i, d_i, ḋ_i, r), lower ≤ x ≤ upper,
///   order conditions (and those of the intermediate regime) = 0,    r_i + Σ_j (p_ij + w_ij) = 1,
///   d_i − ḋ_i ≥ margin,    |R|² − 1 ≤ 0 on a ray if an angle is demanded.
/// Derivatives are exact: gradients by a reverse sweep, second derivatives by one over `tangent`. An object
/// has its own work space: one for each thread. Dimensionless.
class design_problem {
 public:
  /// Unknowns, bounds and equations of a pattern. `demands.given_rows` has no more rows than the
  /// pattern.
  design_problem(zero_pattern pattern, const design_demands& demands);

  const zero_pattern& pattern() const { return pattern_; }    ///< which coefficients are unknowns
  const design_demands& demands() const { return demands_; }  ///< as given
  const Eigen::VectorXd& lower() const { return lower_; }     ///< x ≥ lower
  const Eigen::VectorXd& upper() const { return upper_; }  ///< x ≤ upper; the same as lower() in given rows
  Eigen::Index unknowns() const { return lower_.size(); }  ///< length of x
  /// Number of equations: order conditions and the like; then the row sums.
  Eigen::Index equations() const {
    return static_cast<Eigen::Index>(conditions_.first.size() + rows_.size());
  }
  /// Of equation k: a tree, "flux = 1", "weights of stage 3".
  const std::string& equation_name(Eigen::Index k) const { return names_[static_cast<std::size_t>(k)]; }
  /// Place of r in x, −1 for methods without transport.
  Eigen::Index place_of_r() const { return r_place_; }

  /// Inequalities Σ a_k x_k ≥ margin.
  struct inequality {
    std::vector<std::pair<Eigen::Index, double>> terms;  ///< (k, a_k)
    double least;                                        ///< the margin
  };
  /// d_i − ḋ_i ≥ margin of the stages where both are unknown; elsewhere a bound says it.
  const std::vector<inequality>& inequalities() const { return inequalities_; }

  /// The method with these unknowns; r = 1 if r is none of them.
  shu_osher_form<double> form(const Eigen::VectorXd& x) const;
  /// The unknowns of a method of as many stages; what its pattern has besides is lost.
  Eigen::VectorXd unknowns_of(const shu_osher_form<double>& m) const;

  /// Left-hand minus right-hand sides of all equations().
  Eigen::VectorXd residuals(const Eigen::VectorXd& x);
  /// Gradients of residuals(), equations() × unknowns().
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& x);

  /// Number of values that must not be positive: stability_limits(), if an angle is demanded.
  Eigen::Index limits() const { return limits_ ? static_cast<Eigen::Index>(limits_->first.size()) : 0; }
  /// The values that must not be positive; none without an angle.
  Eigen::VectorXd limit_values(const Eigen::VectorXd& x);
  /// Gradients of limit_values(), limits() × unknowns().
  Eigen::MatrixXd limit_jacobian(const Eigen::VectorXd& x);

  /// What a method may be made small in.
  enum class measure {
    error,  ///< residuals of the next order, error_terms()
    band    ///< residuals of band_terms()
  };
  /// ½ Σ of squared residuals, and its gradient if wanted.
  double half_square(measure what, const Eigen::VectorXd& x, Eigen::VectorXd* gradient = nullptr);

  /// Weights in a sum of second derivatives.
  struct weights {
    Eigen::VectorXd equations,  ///< λ_k
        limits;                 ///< μ_l
    double error = 0.0,         ///< factor of half_square(measure::error, x)
        band = 0.0;             ///< factor of half_square(measure::band, x)
  };
  /// Second derivatives of Σ_k λ_k residual_k + Σ_l μ_l limit_l + the weighted half squares.
  Eigen::MatrixXd hessian(const Eigen::VectorXd& x, const weights& given);

 private:
  enum class part { P, W, initial, d, ddot, r };
  struct unknown {
    part what;
    std::size_t i, j;
  };
  /// The place of an unknown in a form, or nullptr for r_i, which a form does not hold.
  template <class Real>
  static Real* entry(shu_osher_form<Real>& m, const unknown& u);
  template <class Real>
  shu_osher_form<Real> form_of(const std::vector<Real>& x) const;
  template <class Real>
  shu_osher_form<Real> empty_form() const;
  /// Values and gradients, and the same with second derivatives.
  struct sweeps {
    sweeps(const condition_list& list, const std::vector<char>& slow)
        : first(list, slow), second(list, slow) {}
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
  std::optional<sweeps> limits_, error_, band_;
};

}  // namespace apsis
