// Targets that are a polynomial times a product of lines, and their moments (model/gas_target.hpp).
#if defined(APSIS_MODEL_FORMULAS_TARGET_MOMENTS) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_TARGET_MOMENTS
#undef APSIS_MODEL_FORMULAS_TARGET_MOMENTS
#else
#define APSIS_MODEL_FORMULAS_TARGET_MOMENTS
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/formulas/target.hpp>
#include <apsis/model/line_moments.hpp>
#include <apsis/model/target_polynomial.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Largest relative difference between the moments of a target and ω.
inline constexpr double target_accuracy = 1e-14;
/// Smallest variance of a base in units of Δv². Narrower Gaussians have other moments on the grid.
inline constexpr double narrowest_target = 0.25;
/// Relative size of a defect that counts as rounding.
inline constexpr double target_rounding = 4.5e-16;

/// Returns P along last lines of a grid of D dimensions. `last` is the direction of the lines. `across` are
/// the directions of the other components c. `Cubic` states whether P has terms of third degree.
template <int D, bool Cubic, class N>
APSIS_FORMULA cubic_polynomial<N> polynomial_on_line(const target_polynomial& p, const int* across, int last,
                                                     const N* c) {
  // NOLINTNEXTLINE(misc-const-correctness): polynomials of second degree do not change it.
  N square(0.0), along(0.0);
  cubic_polynomial<N> of_line{N(p.k), N(p.l[last]), N(p.a[last][last]), N(p.w[last])};
  for (int k = 0; k + 1 < D; ++k) {
    const int i = across[k];
    if constexpr (Cubic) {
      square = square + c[k] * c[k];
      along = along + N(p.w[i]) * c[k];
    }
    of_line.k0 = of_line.k0 + N(p.l[i]) * c[k];
    of_line.k1 = of_line.k1 + N(2.0 * p.a[i][last]) * c[k];
    for (int l = 0; l + 1 < D; ++l) of_line.k0 = of_line.k0 + N(p.a[i][across[l]]) * c[k] * c[l];
  }
  if constexpr (Cubic) {
    of_line.k0 = of_line.k0 + along * square;
    of_line.k1 = of_line.k1 + N(p.w[last]) * square;
    of_line.k2 = of_line.k2 + along;
  }
  return of_line;
}

/// The defects of the moments about the bulk velocity, each relative to its scale.
struct target_defect {
  double mass = 0.0, energy = 0.0;
  double momentum[3] = {};

  APSIS_FORMULA double size() const {
    const double of_mass = __builtin_fabs(mass), of_energy = __builtin_fabs(energy),
                 of_momentum = largest_momentum();
    const double larger_one = of_mass < of_energy ? of_energy : of_mass;
    return larger_one < of_momentum ? of_momentum : larger_one;
  }
  APSIS_FORMULA double largest_momentum() const {
    double largest = __builtin_fabs(momentum[0]);
    for (int k = 1; k < 3; ++k) {
      const double other = __builtin_fabs(momentum[k]);
      if (largest < other) largest = other;
    }
    return largest;
  }
};

/// The polynomial α + β·c + γ|c|².
struct target_correction {
  double k;          ///< α
  double l[3] = {};  ///< β
  double a;          ///< γ

  APSIS_FORMULA void add_to(target_polynomial& p, int d) const {
    p.k += k;
    for (int i = 0; i < d; ++i) {
      p.l[i] += l[i];
      p.a[i][i] += a;
    }
  }
};

/// Returns the polynomial that removes a defect if the base is a Gaussian of this variance in d directions.
APSIS_FORMULA target_correction correction_of(const target_defect& found, int d, double variance) {
  target_correction by{};
  by.a = -(found.energy - 0.5 * d * found.mass) / (d * variance);
  by.k = -found.mass - by.a * d * variance;
  for (int i = 0; i < d; ++i) by.l[i] = -found.momentum[i] / __builtin_sqrt(variance);
  return by;
}

/// Moments of polynomials times a product of lines in D directions. They restore the moments of a target
/// without a pass over its row.
template <int D>
struct moments_of_product {
  const line_moments& lines;  ///< moments of the directions
  double square = 0.0,        ///< ⟨|c|²⟩
      fourth = 0.0;           ///< ⟨|c|⁴⟩
  double of_square[3] = {};   ///< ⟨c_k |c|²⟩

  explicit APSIS_FORMULA moments_of_product(const line_moments& of_lines) : lines(of_lines) {
    for (int k = 0; k < D; ++k) square += lines.of[k][2];
    for (int k = 0; k < D; ++k) {
      const double* of = lines.of[k];
      of_square[k] = of[3] + of[1] * (square - of[2]);
      fourth += of[4] + of[2] * (square - of[2]);
    }
  }

  /// Corrects the shape such that the target has the moments of its base. Returns false if the corrections do
  /// not contract.
  APSIS_FORMULA bool correct(target_shape& shape) const {
    target_defect found = defect_of(shape);
    double best = 1e300;
    for (int iteration = 0; iteration < 12; ++iteration) {
      const double size = found.size();
      if (size <= target_rounding) return true;
      if (!(size < 0.7 * best)) return size <= target_accuracy;
      best = size;
      const target_correction by = correction_of(found, D, shape.variance);
      by.add_to(shape.of_g, D);
      add(by, shape.variance, found);
    }
    return false;
  }

 private:
  struct powers {
    int of[3] = {};
  };

  /// Returns ⟨Π c_k^p_k⟩.
  APSIS_FORMULA double mean(const powers& p) const {
    double product = 1.0;
    for (int k = 0; k < D; ++k) product *= lines.of[k][p.of[k]];
    return product;
  }

  /// Returns ⟨P Π c_k^p_k⟩.
  APSIS_FORMULA double mean(const target_polynomial& polynomial, const powers& p) const {
    double sum = polynomial.k * mean(p);
    for (int k = 0; k < D; ++k) {
      powers with = p;
      ++with.of[k];
      sum += polynomial.l[k] * mean(with);
      for (int l = 0; l < D; ++l) {
        powers pair = with;
        ++pair.of[l];
        sum += polynomial.a[k][l] * mean(pair);
        ++pair.of[l];
        sum += polynomial.w[k] * mean(pair);
      }
    }
    return sum;
  }

  APSIS_FORMULA target_defect defect_of(const target_shape& shape) const {
    target_defect found;
    found.mass = mean(shape.of_g, {}) - 1.0;
    double energy = lines.others > 0.0 ? lines.others * (mean(shape.of_h, {}) - 1.0) : 0.0;
    for (int k = 0; k < D; ++k) {
      powers p;
      p.of[k] = 1;
      found.momentum[k] = mean(shape.of_g, p) / __builtin_sqrt(shape.variance);
      p.of[k] = 2;
      energy += mean(shape.of_g, p) - mean(p);
    }
    found.energy = 0.5 * energy / shape.variance;
    return found;
  }

  /// Adds the moments of a correction to a defect.
  APSIS_FORMULA void add(const target_correction& by, double variance, target_defect& found) const {
    const double speed = __builtin_sqrt(variance);
    double of_l = 0.0, energy = by.k * square + by.a * fourth;
    for (int k = 0; k < D; ++k) {
      of_l += by.l[k] * lines.of[k][1];
      energy += by.l[k] * of_square[k];
    }
    for (int k = 0; k < D; ++k) {
      const double* of = lines.of[k];
      // ⟨c_k β·c⟩
      const double with_l = of[1] * (by.k + of_l - by.l[k] * of[1]) + by.l[k] * of[2];
      found.momentum[k] += (with_l + by.a * of_square[k]) / speed;
    }
    found.mass += by.k + of_l + by.a * square;
    found.energy += 0.5 * energy / variance;
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
