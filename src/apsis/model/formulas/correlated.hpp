// Gaussians with correlated components (model/correlated_gaussian.hpp).
#if defined(APSIS_MODEL_FORMULAS_CORRELATED) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_CORRELATED
#undef APSIS_MODEL_FORMULAS_CORRELATED
#else
#define APSIS_MODEL_FORMULAS_CORRELATED
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/formulas/exponential.hpp>
#include <apsis/model/formulas/small_matrix.hpp>
#include <apsis/model/formulas/velocity_line.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The Gaussian ρ (det 2πΘ)^{−1/2} exp(−½ cᵀΘ⁻¹c) of D components, as a Gaussian a(c') exp(−(c − s·c')²/(2V))
/// in the component c of the last line. c' are the other components, and a(c') is a Gaussian in them. s are
/// the slopes of the mean, V is the variance.
template <int D>
struct conditional_gaussian {
  double variance,     ///< V
      height;          ///< a(0)
  double outer[2][2],  ///< inverse of the covariance of c'
      slope[2];        ///< s

  /// Returns the Gaussian of density ρ. `last` is the component c and `across` are the components c'.
  static APSIS_FORMULA conditional_gaussian of(double rho, const small_matrix<D>& covariance,
                                               const small_matrix<D>& inverse, int last, const int* across) {
    constexpr double twice_pi = 2.0 * 3.14159265358979323846;
    conditional_gaussian found{1.0 / inverse.of[last][last], 0.0, {}, {}};
    // NOLINTNEXTLINE(misc-const-correctness): one component does not change it.
    double determinant = found.variance * twice_pi;
    if constexpr (D == 2) {
      const double variance = covariance.of[across[0]][across[0]];
      found.outer[0][0] = 1.0 / variance;
      determinant *= variance * twice_pi;
    } else if constexpr (D == 3) {
      const int i = across[0], j = across[1];
      const double ii = covariance.of[i][i], ij = covariance.of[i][j], jj = covariance.of[j][j];
      const double of_others = ii * jj - ij * ij;
      found.outer[0][0] = jj / of_others;
      found.outer[0][1] = found.outer[1][0] = -ij / of_others;
      found.outer[1][1] = ii / of_others;
      determinant *= of_others * twice_pi * twice_pi;
    }
    found.height = rho / __builtin_sqrt(determinant);
    for (int k = 0; k + 1 < D; ++k) found.slope[k] = -inverse.of[last][across[k]] * found.variance;
    return found;
  }

  /// Returns log(a(c')/a(0)).
  APSIS_FORMULA double log_of_relative_height(const double* c) const {
    if constexpr (D == 1) {
      return 0.0;
    } else if constexpr (D == 2) {
      return -0.5 * outer[0][0] * c[0] * c[0];
    } else {
      return -0.5 * (outer[0][0] * c[0] * c[0] + 2.0 * outer[0][1] * c[0] * c[1] + outer[1][1] * c[1] * c[1]);
    }
  }
  /// Returns the Gaussian along the last line at other components c'. The bulk velocity along the line is u,
  /// and `relative_height` is a(c')/a(0).
  APSIS_FORMULA gaussian_of_line on_line(const double* c, double u, double relative_height) const {
    double shift = 0.0;
    for (int k = 0; k + 1 < D; ++k) shift += slope[k] * c[k];
    return {height * relative_height, u + shift, variance};
  }
  /// Returns the same Gaussian, with a(c')/a(0) computed here.
  APSIS_FORMULA gaussian_of_line on_line(const double* c, double u) const {
    return on_line(c, u, exp_of(log_of_relative_height(c)));
  }
};

/// A Gaussian of three components as a product of three tables. With s·c' = s₁c₁ + s₂c₂ it is
///   a(c') exp((s₁c₁ − s₂c₂)²/(2V)) · exp(−(c − 2s₁c₁)²/(4V)) · exp(−(c − 2s₂c₂)²/(4V)):
/// one table in c₁ and c₂, one in c₁ and c, and one in c₂ and c. Each table consists of Gaussians on lines.
struct correlated_tables {
  conditional_gaussian<3> of;
  double outer[2][2];  ///< coefficients of the exponent of the first table; [1][0] is unused
  double u[3];         ///< bulk velocity

  static APSIS_FORMULA correlated_tables from(const conditional_gaussian<3>& of, const double* u) {
    const double per_variance = 1.0 / of.variance;
    correlated_tables tables{of, {}, {u[0], u[1], u[2]}};
    for (int k = 0; k < 2; ++k)
      tables.outer[k][k] = of.outer[k][k] - of.slope[k] * of.slope[k] * per_variance;
    tables.outer[0][1] = of.outer[0][1] + of.slope[0] * of.slope[1] * per_variance;
    return tables;
  }

  /// Whether all values and factors are normal numbers. `farthest` has the largest |c_k| of the velocities.
  APSIS_FORMULA bool fit(const double* farthest) const {
    constexpr double most = 600.0;  // sum of the exponents
    const bool bounded = outer[1][1] > 0.0 && outer[0][0] * outer[1][1] > outer[0][1] * outer[0][1];
    if (!(bounded && of.height > 1e-30 && of.height < 1e30)) return false;
    double sum = __builtin_fabs(outer[0][1]) * farthest[0] * farthest[1];
    for (int k = 0; k < 2; ++k) {
      const double end = farthest[2] + 2.0 * __builtin_fabs(of.slope[k]) * farthest[k];
      sum += 0.5 * outer[k][k] * farthest[k] * farthest[k] + 0.25 * end * end / of.variance;
    }
    return sum < most;
  }

  /// Returns a(c') exp((s₁c₁ − s₂c₂)²/(2V)) as a Gaussian along the second direction, for the velocity v
  /// along the first.
  APSIS_FORMULA gaussian_of_line across(double v) const {
    const double shift = -outer[0][1] / outer[1][1], rest = outer[0][0] + outer[0][1] * shift, c = v - u[0];
    return {of.height * exp_of(-0.5 * rest * c * c), u[1] + shift * c, 1.0 / outer[1][1]};
  }
  /// Returns exp(−(c − 2s_k c_k)²/(4V)) along the last direction, for the velocity v along direction k.
  APSIS_FORMULA gaussian_of_line along(int k, double v) const {
    return {1.0, u[2] + 2.0 * of.slope[k] * (v - u[k]), 2.0 * of.variance};
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
