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
#include <apsis/model/plane_walk.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Whether products of a factor of this height and exponentials stay normal numbers. The exponents have this
/// sum.
APSIS_FORMULA bool are_normal(double height, double exponents) {
  return height > 1e-30 && height < 1e30 && exponents < 600.0;
}

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

/// A Gaussian a exp(−½(A x² + 2Bxy + C y²)) on a plane of velocities. x is the component of a row and y that
/// along it.
struct correlated_plane {
  double height,  ///< a
      xx, xy,     ///< A, B
      yy;         ///< C > 0

  /// Returns a bound on the exponents where |x| and |y| are at most these numbers.
  APSIS_FORMULA double largest_exponent(double x, double y) const {
    return 0.5 * xx * x * x + __builtin_fabs(xy) * x * y + 0.5 * yy * y * y;
  }
  /// Returns the Gaussian along the row at x. The bulk velocity along rows is u.
  APSIS_FORMULA gaussian_of_line row(double x, double u) const {
    const double shift = -xy / yy, rest = xx + xy * shift;
    return {height * exp_of(-0.5 * rest * x * x), u + shift * x, 1.0 / yy};
  }
  /// Whether walks over evenly spaced rows are accurate. `variance` is that of x in the whole Gaussian. A
  /// value k rows away has k²/2 roundings. Ten rows per standard deviation keep these below 40 roundings of
  /// the largest value.
  APSIS_FORMULA bool walks(double spacing, double variance) const {
    const double square = spacing * spacing;
    return square >= 0.01 * variance && xx * square <= 16.0;
  }
  /// Returns the walk over these rows. The bulk velocity across rows is u_across, and that along them u.
  APSIS_FORMULA plane_walk walk(const spaced_line& rows, double u_across, double u) const {
    const double h = rows.spacing, at = u_across / h + 0.5 * rows.n;
    const double inside = at > 0.0 ? at < rows.n - 1.0 ? at : rows.n - 1.0 : 0.0;  // 0 for NaN
    const int first = static_cast<int>(inside);
    const double x = distance_to(u_across, h, first + 0.5 - 0.5 * rows.n);
    const gaussian_of_line start = row(x, u);
    return {start.a, start.u, start.T, u, -xx * h * (x + 0.5 * h), xy * h, -xx * h * h, rows.n, first};
  }
};

/// Returns the plane of a Gaussian of two components.
template <int D>
APSIS_FORMULA correlated_plane plane_of(const conditional_gaussian<D>& of) {
  static_assert(D == 2);
  const double per = 1.0 / of.variance, slope = of.slope[0];
  return {of.height, of.outer[0][0] + slope * slope * per, -slope * per, per};
}

/// A Gaussian of three components as a product of three tables. With s·c' = s₁c₁ + s₂c₂ it is
///   a(c') exp((s₁c₁ − s₂c₂)²/(2V)) · exp(−(c − 2s₁c₁)²/(4V)) · exp(−(c − 2s₂c₂)²/(4V)):
/// one table in c₁ and c₂, one in c₁ and c, and one in c₂ and c.
struct correlated_tables {
  correlated_plane across,  ///< in c₁ and c₂
      along[2];             ///< in c₁ and c, and in c₂ and c

  static APSIS_FORMULA correlated_tables from(const conditional_gaussian<3>& of) {
    const double per = 1.0 / of.variance, s1 = of.slope[0], s2 = of.slope[1];
    correlated_tables tables{{of.height, of.outer[0][0] - s1 * s1 * per, of.outer[0][1] + s1 * s2 * per,
                              of.outer[1][1] - s2 * s2 * per},
                             {}};
    for (int k = 0; k < 2; ++k) {
      const double s = of.slope[k];
      tables.along[k] = {1.0, 2.0 * s * s * per, -s * per, 0.5 * per};
    }
    return tables;
  }

  /// Whether all values and factors are normal numbers. `farthest` has the largest |c_k| of the velocities.
  APSIS_FORMULA bool fit(const double* farthest) const {
    const bool bounded = across.yy > 0.0 && across.xx * across.yy > across.xy * across.xy;
    return bounded && are_normal(across.height, across.largest_exponent(farthest[0], farthest[1]) +
                                                    along[0].largest_exponent(farthest[0], farthest[2]) +
                                                    along[1].largest_exponent(farthest[1], farthest[2]));
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
