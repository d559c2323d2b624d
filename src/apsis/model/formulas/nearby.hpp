// The formulas of model/nearby_maxwellian.hpp: Newton's method for weights w = exp(βc + γc²) along each
// direction of a grid, c = v − u, starting from Gaussians.
#if defined(APSIS_MODEL_FORMULAS_NEARBY) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_NEARBY
#undef APSIS_MODEL_FORMULAS_NEARBY
#else
#define APSIS_MODEL_FORMULAS_NEARBY
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/formulas/exponential.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Least density for which no significant weight is a subnormal number.
inline constexpr double dense_enough = 1e-250;

/// Sums of the weights along one direction.
struct weighted_direction {
  double farthest;  ///< largest |c|
  double sums[6];   ///< Σ w c^p

  /// Sets `farthest` from the first and last c of the direction.
  APSIS_FORMULA void set_ends(double first, double last) {
    const double left = __builtin_fabs(first), right = __builtin_fabs(last);
    farthest = left < right ? right : left;
  }
  APSIS_FORMULA double mean() const { return sums[1] / sums[0]; }
  APSIS_FORMULA double mean_square() const { return sums[2] / sums[0]; }

  /// Derivatives of ⟨c⟩ and ⟨c²⟩ by β and γ. The derivative of ⟨c²⟩ by β equals mean_by_gamma.
  struct slopes {
    double mean_by_beta, mean_by_gamma, square_by_gamma;
  };
  APSIS_FORMULA slopes differentiate() const {
    const double per_mass = 1.0 / sums[0], c = sums[1] * per_mass, square = sums[2] * per_mass;
    return {square - c * c, sums[3] * per_mass - c * square, sums[4] * per_mass - square * square};
  }
  /// Returns a bound on |βc + γc²|.
  APSIS_FORMULA double largest_exponent(double beta, double gamma) const {
    return (__builtin_fabs(beta) + __builtin_fabs(gamma) * farthest) * farthest;
  }
};

/// Newton's method for ⟨c_k⟩ = 0 and Σ_k ⟨c_k²⟩ = d T. Steps multiply weights by exponentials of small
/// numbers. The caller changes the weights and sums them:
///   while (newton.advance()) for all k: w ← w exp(newton.beta[k] c + newton.gamma c²), newton.of[k].sums ← …
struct nearby_newton {
  weighted_direction of[3];  ///< weights of each direction
  int dimensions;            ///< number of directions
  double square, speed;      ///< d T, √T
  double beta[3], gamma;     ///< parameters of the next change
  double before;             ///< defect before the last change
  int changes;               ///< number of changes of the weights so far
  bool found;                ///< whether the weights have the moments of the state

  /// Returns the start for a temperature T. The caller then sets `of`.
  static APSIS_FORMULA nearby_newton start(int dimensions, double T) {
    nearby_newton newton;
    newton.dimensions = dimensions;
    newton.square = dimensions * T;
    newton.speed = __builtin_sqrt(T);
    newton.before = __builtin_huge_val();
    newton.changes = 0;
    newton.found = false;
    return newton;
  }

  /// Returns true if the caller must change the weights. Returns false if they have the moments, or if the
  /// next step is not small or Newton's method does not converge.
  APSIS_FORMULA bool advance() {
    constexpr double rounding = 4.5e-16;  // two roundings
    constexpr double close = 1e-13;       // rounding may keep sums of a few dozen terms at this distance
    constexpr int most_changes = 8;
    if (changes == most_changes) return false;
    const double size = defect();
    found = size <= rounding || (size < close && !(size < 0.5 * before));
    if (found || !(size < before)) return false;
    before = size;
    ++changes;
    return step();
  }

  /// Returns the product of the masses of all directions.
  APSIS_FORMULA double mass() const {
    double product = 1.0;
    for (int k = 0; k < dimensions; ++k) product *= of[k].sums[0];
    return product;
  }

 private:
  APSIS_FORMULA double missing_square() const {
    double rest = square;
    for (int k = 0; k < dimensions; ++k) rest -= of[k].mean_square();
    return rest;
  }

  /// Returns the largest relative residual; NaN without mass.
  APSIS_FORMULA double defect() const {
    double largest = __builtin_fabs(missing_square()) / square;
    for (int k = 0; k < dimensions; ++k) {
      const double h = __builtin_fabs(of[k].mean()) / speed;
      if (!(h <= largest)) largest = h;
    }
    return largest;
  }

  /// Computes β_k and γ, with the β_k eliminated from the equation of the energy. Returns true if the step
  /// is small.
  APSIS_FORMULA bool step() {
    double means[3], by_gamma[3];  // in units of the slope by β
    double rest = missing_square(), slope = 0.0;
    for (int k = 0; k < dimensions; ++k) {
      const auto by = of[k].differentiate();
      means[k] = of[k].mean() / by.mean_by_beta;
      by_gamma[k] = by.mean_by_gamma / by.mean_by_beta;
      rest += by.mean_by_gamma * means[k];
      slope += by.square_by_gamma - by.mean_by_gamma * by_gamma[k];
    }
    gamma = rest / slope;
    bool small = true;
    for (int k = 0; k < dimensions; ++k) {
      beta[k] = -means[k] - by_gamma[k] * gamma;
      small = small && of[k].largest_exponent(beta[k], gamma) <= small_exponent;
    }
    return small;
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
