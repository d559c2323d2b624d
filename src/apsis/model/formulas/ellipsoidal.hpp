// The Gaussian of the ellipsoidal model (model/models/es_bgk.cpp) and its moments.
#if defined(APSIS_MODEL_FORMULAS_ELLIPSOIDAL) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_ELLIPSOIDAL
#undef APSIS_MODEL_FORMULAS_ELLIPSOIDAL
#else
#define APSIS_MODEL_FORMULAS_ELLIPSOIDAL
#endif

#include <apsis/core/relaxation_weights.hpp>
#include <apsis/exec/number.hpp>
#include <apsis/model/fluid_state.hpp>
#include <apsis/model/formulas/small_matrix.hpp>
#include <apsis/model/formulas/target_moments.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// The ellipsoidal model whose stress relaxes with the rate λ C.
struct ellipsoidal_model {
  double rate_of_stress;  ///< λ = 1/Pr

  /// Returns the factor by which a stage multiplies the stress.
  APSIS_FORMULA double decay(const stage_coefficients& of) const {
    return 1.0 / (1.0 + rate_of_stress * of.a + rate_of_stress * rate_of_stress * of.b);
  }
  /// Returns the weight λB/(A + B) of Q̇ in the target of a stage.
  APSIS_FORMULA double weight_of_derivative(const stage_coefficients& of) const {
    return rate_of_stress * of.weight_of_b;
  }
};

/// The target of a stage of this model in D resolved directions: a Gaussian times a quadratic.
template <int D>
struct ellipsoidal_target {
  small_matrix<D> covariance,  ///< Θ̂ of the Gaussian in the resolved directions
      inverse;                 ///< Θ̂⁻¹
  double others;               ///< h/g of the Gaussian
  bool exists;                 ///< whether Θ̂ is positive definite; other members are undefined if not
  target_shape shape;          ///< the quadratic

  /// Returns the target for `part` times the deviations Θ_kl − T δ_kl, k ≤ l. `derivative` is the weight of
  /// Q̇, and `unresolved` the number of degrees of freedom that the grid does not resolve.
  static APSIS_FORMULA ellipsoidal_target of(const ellipsoidal_model& model, const fluid_state& state,
                                             const double* deviations, double derivative, double part,
                                             int unresolved) {
    ellipsoidal_target target;
    small_matrix<D> change;  // (1 − λ) of the deviation
    for (int k = 0; k < D; ++k)
      for (int l = k; l < D; ++l)
        change.of[k][l] = change.of[l][k] = part * (1.0 - model.rate_of_stress) * *deviations++;
    const double change_of_others = unresolved > 0 ? -change.trace() / unresolved : 0.0;
    target.covariance = change;
    for (int k = 0; k < D; ++k) target.covariance.of[k][k] += state.T;
    const double T_of_others = state.T + change_of_others;
    target.others = unresolved * T_of_others;
    target.exists = cholesky_factor<D>(target.covariance).positive_definite && T_of_others > 0.0;
    target.inverse = inverse_of(target.covariance);
    target.shape.variance = target.covariance.trace() / D;
    const small_matrix<D> relative = product_of(target.inverse, change),
                          quadratic = product_of(relative, target.inverse);
    target.shape.of_g.k = 1.0 - 0.5 * derivative * relative.trace();
    for (int k = 0; k < D; ++k)
      for (int l = 0; l < D; ++l) target.shape.of_g.a[k][l] = 0.5 * derivative * quadratic.of[k][l];
    target.shape.of_h = target.shape.of_g;
    target.shape.of_h.k += derivative * change_of_others / T_of_others;
    return target;
  }
};

/// Moments of a base (g, θ g) and of its target.
struct base_contents {
  double rho,  ///< density ρ
      others,  ///< θ
      energy;  ///< Σ (|c|² e_g + e_h)/ρ, twice the internal energy of the target per density
};

/// Moments of polynomials of degree 2 times an arbitrary row g in D directions. They follow from sums(p), the
/// central moments of g with exponents p up to degree 4.
template <int D, class Sums>
struct moments_of_base {
  struct exponents {
    int of[3] = {};
  };

  const Sums& sums;
  base_contents contents;

  /// Corrects the shape such that the target has the density and energy of the contents, and no momentum.
  /// Returns false if rounding prevents this.
  ///
  /// The equations are linear, so that the correction of a small defect is exact to rounding. They are
  /// singular if nearly all mass of the row is at a few points.
  APSIS_FORMULA bool correct(target_shape& shape) const {
    constexpr double small = 1e-2;
    for (int iteration = 0; iteration < 4; ++iteration) {
      const target_defect found = defect_of(shape);
      if (found.size() <= target_rounding) return true;
      correction_of_base(found, shape.variance).add_to(shape.of_g, D);
      if (found.size() < small) return defect_of(shape).size() <= target_accuracy;
    }
    return false;
  }

 private:
  // Loops are unrolled, because the exponents are then constants. Most of the time would otherwise pass with
  // finding the places of the moments.

  /// Returns Σ g Π c_k over up to four directions; −1 stands for no direction.
  APSIS_FORMULA double along(int i = -1, int j = -1, int k = -1, int l = -1) const {
    exponents p;
#pragma GCC unroll 3
    for (int n = 0; n < D; ++n) p.of[n] = (i == n) + (j == n) + (k == n) + (l == n);
    return sums(p.of);
  }

  /// Returns ⟨P Π c_k^p_k⟩.
  APSIS_FORMULA double mean(const target_polynomial& polynomial, const exponents& p) const {
    double sum = polynomial.k * sums(p.of);
#pragma GCC unroll 3
    for (int k = 0; k < D; ++k) {
      exponents with = p;
      ++with.of[k];
      sum += polynomial.l[k] * sums(with.of);
#pragma GCC unroll 3
      for (int l = 0; l < D; ++l) {
        exponents pair = with;
        ++pair.of[l];
        sum += polynomial.a[k][l] * sums(pair.of);
      }
    }
    return sum / contents.rho;
  }

  APSIS_FORMULA target_defect defect_of(const target_shape& shape) const {
    target_defect found;
    found.mass = mean(shape.of_g, {}) - 1.0;
    double energy = contents.others * mean(shape.of_h, {}) - contents.energy;
#pragma GCC unroll 3
    for (int k = 0; k < D; ++k) {
      exponents p;
      p.of[k] = 1;
      found.momentum[k] = mean(shape.of_g, p) / __builtin_sqrt(shape.variance);
      p.of[k] = 2;
      energy += mean(shape.of_g, p);
    }
    found.energy = 0.5 * energy / shape.variance;
    return found;
  }

  /// Returns the correction Σ y_i φ_i with φ = (1, c_k/√V, ½|c|²/V). The y_i solve a system whose matrix has
  /// the moments of φ_i φ_j.
  APSIS_FORMULA target_correction correction_of_base(const target_defect& found, double variance) const {
    constexpr int size = D + 2, energy = size - 1;
    const double speed = __builtin_sqrt(variance);
    small_matrix<size> products;
    double y[size];
    products.of[0][0] = along();
    y[0] = found.mass;
    y[energy] = found.energy;
#pragma GCC unroll 3
    for (int k = 0; k < D; ++k) {
      const int row = k + 1;
      y[row] = found.momentum[k];
      products.of[row][0] = along(k) / speed;
      products.of[energy][0] += 0.5 * along(k, k) / variance;
#pragma GCC unroll 3
      for (int l = 0; l < D; ++l) {
        products.of[row][l + 1] = along(k, l) / variance;
        products.of[energy][row] += 0.5 * along(k, l, l) / (variance * speed);
        products.of[energy][energy] += 0.25 * along(k, k, l, l) / (variance * variance);
      }
    }
    cholesky_factor<size>(products).solve(y);
    target_correction by{};
    by.k = -contents.rho * y[0];
#pragma GCC unroll 3
    for (int k = 0; k < D; ++k) by.l[k] = -contents.rho * y[k + 1] / speed;
    by.a = -contents.rho * 0.5 * y[energy] / variance;
    return by;
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
