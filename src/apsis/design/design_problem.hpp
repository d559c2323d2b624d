#pragma once

#include <apsis/design/conditions.hpp>
#include <apsis/design/tangent.hpp>

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace apsis {

/// Which coefficients of a method may differ from zero.
struct zero_pattern {
  method_kind kind = method_kind::imex;
  matrix<char> P, W;          ///< s × s, strictly lower triangular
  std::vector<char> d, ddot;  ///< s
  std::vector<char> initial;  ///< whether r_i may differ from zero; r_1 = 1 always
  std::size_t stages() const { return d.size(); }
  /// Stages whose T enters a later one.
  std::vector<char> transport() const;
};

/// All coefficients free; T is evaluated at the stages in `transport` only.
zero_pattern full_pattern(method_kind kind, const std::vector<char>& transport);

/// What is asked of a method besides its pattern.
struct design_demands {
  int order = 2;
  double box = 2.0;         ///< d_i ≤ box, |ḋ_i| ≤ box
  double margin = 1e-3;     ///< d_i + |ḋ_i| ≥ margin: type A
  double least_r = 0.01;    ///< r ≥ least_r (methods with transport)
  double largest_r = 64.0;  ///< r ≤ largest_r
  regime_demand regime = regime_demand::none;
  double least_angle = 0.0;  ///< α of A(α)-stability of the implicit part, in degrees
  double least_pole = 0.0;   ///< poles of stages with d = 0 are at ±i/√|ḋ|: 1/√|ḋ| at least
  int most_buffers = 1000;   ///< state-sized buffers of a step; looked at once a method is found
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
  design_problem(zero_pattern pattern, const design_demands& demands);

  const zero_pattern& pattern() const { return pattern_; }
  const design_demands& demands() const { return demands_; }
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }
  Eigen::Index unknowns() const { return lower_.size(); }
  /// Order conditions and the like; then the row sums.
  Eigen::Index equations() const {
    return static_cast<Eigen::Index>(conditions_.first.size() + rows_.size());
  }
  const std::string& equation_name(Eigen::Index k) const { return names_[static_cast<std::size_t>(k)]; }
  /// Place of r in x, −1 for methods without transport.
  Eigen::Index place_of_r() const { return r_place_; }

  /// Inequalities Σ a_k x_k ≥ margin.
  struct inequality {
    std::vector<std::pair<Eigen::Index, double>> terms;
    double least;
  };
  const std::vector<inequality>& inequalities() const { return inequalities_; }

  shu_osher_form<double> form(const Eigen::VectorXd& x) const;
  Eigen::VectorXd unknowns_of(const shu_osher_form<double>& m) const;

  Eigen::VectorXd residuals(const Eigen::VectorXd& x);
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& x);

  /// What must not be positive: stability_limits(), if an angle is demanded.
  Eigen::Index limits() const { return limits_ ? static_cast<Eigen::Index>(limits_->first.size()) : 0; }
  Eigen::VectorXd limit_values(const Eigen::VectorXd& x);
  Eigen::MatrixXd limit_jacobian(const Eigen::VectorXd& x);

  /// ½ Σ of squared residuals: those of the next order (`error`), or band_terms(); and its gradient.
  enum class measure { error, band };
  double half_square(measure what, const Eigen::VectorXd& x, Eigen::VectorXd* gradient = nullptr);

  /// Weights in a sum of second derivatives.
  struct weights {
    Eigen::VectorXd equations, limits;
    double error = 0.0, band = 0.0;
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
