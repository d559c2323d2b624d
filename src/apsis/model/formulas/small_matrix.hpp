// Symmetric matrices of few rows.
#if defined(APSIS_MODEL_FORMULAS_SMALL_MATRIX) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_SMALL_MATRIX
#undef APSIS_MODEL_FORMULAS_SMALL_MATRIX
#else
#define APSIS_MODEL_FORMULAS_SMALL_MATRIX
#endif

#include <apsis/exec/number.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// A matrix of N rows and columns.
template <int N>
struct small_matrix {
  double of[N][N] = {};  ///< row by row

  APSIS_FORMULA double trace() const {
    double sum = 0.0;
    for (int k = 0; k < N; ++k) sum += of[k][k];
    return sum;
  }
};

/// Returns A B.
template <int N>
APSIS_FORMULA small_matrix<N> product_of(const small_matrix<N>& a, const small_matrix<N>& b) {
  small_matrix<N> c;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j)
      for (int k = 0; k < N; ++k) c.of[i][j] += a.of[i][k] * b.of[k][j];
  return c;
}

/// The Cholesky factor L of a symmetric matrix A = L Lᵀ. Only the lower half of A is read.
template <int N>
struct cholesky_factor {
  small_matrix<N> lower;   ///< L
  bool positive_definite;  ///< whether A is positive definite up to rounding; if not, L is undefined

  explicit APSIS_FORMULA cholesky_factor(const small_matrix<N>& a) : lower(), positive_definite(true) {
    for (int j = 0; j < N; ++j) {
      double pivot = a.of[j][j];
      for (int k = 0; k < j; ++k) pivot -= lower.of[j][k] * lower.of[j][k];
      positive_definite = positive_definite && pivot > 0.0;
      lower.of[j][j] = __builtin_sqrt(pivot);
      for (int i = j + 1; i < N; ++i) {
        double sum = a.of[i][j];
        for (int k = 0; k < j; ++k) sum -= lower.of[i][k] * lower.of[j][k];
        lower.of[i][j] = sum / lower.of[j][j];
      }
    }
  }

  /// x ← A⁻¹x.
  APSIS_FORMULA void solve(double (&x)[N]) const {
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < i; ++k) x[i] -= lower.of[i][k] * x[k];
      x[i] /= lower.of[i][i];
    }
    for (int i = N - 1; i >= 0; --i) {
      for (int k = i + 1; k < N; ++k) x[i] -= lower.of[k][i] * x[k];
      x[i] /= lower.of[i][i];
    }
  }
};

/// Returns the inverse of a symmetric matrix of at most three rows, by cofactors.
template <int N>
APSIS_FORMULA small_matrix<N> inverse_of(const small_matrix<N>& a) {
  static_assert(N <= 3);
  small_matrix<N> inverse;
  if constexpr (N == 1) {
    inverse.of[0][0] = 1.0 / a.of[0][0];
  } else if constexpr (N == 2) {
    const double per = 1.0 / (a.of[0][0] * a.of[1][1] - a.of[0][1] * a.of[0][1]);
    inverse.of[0][0] = a.of[1][1] * per;
    inverse.of[1][1] = a.of[0][0] * per;
    inverse.of[0][1] = inverse.of[1][0] = -a.of[0][1] * per;
  } else {
    const auto cofactor = [&](int i, int j) {
      const int r = i == 0 ? 1 : 0, s = i == 2 ? 1 : 2, p = j == 0 ? 1 : 0, q = j == 2 ? 1 : 2;
      const double minor = a.of[r][p] * a.of[s][q] - a.of[r][q] * a.of[s][p];
      return (i + j) % 2 == 0 ? minor : -minor;
    };
    const double c00 = cofactor(0, 0), c01 = cofactor(0, 1), c02 = cofactor(0, 2);
    const double per = 1.0 / (a.of[0][0] * c00 + a.of[0][1] * c01 + a.of[0][2] * c02);
    inverse.of[0][0] = c00 * per;
    inverse.of[1][1] = cofactor(1, 1) * per;
    inverse.of[2][2] = cofactor(2, 2) * per;
    inverse.of[0][1] = inverse.of[1][0] = c01 * per;
    inverse.of[0][2] = inverse.of[2][0] = c02 * per;
    inverse.of[1][2] = inverse.of[2][1] = cofactor(1, 2) * per;
  }
  return inverse;
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
