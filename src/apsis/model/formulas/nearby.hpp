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
template <class N>
struct weighted_direction {
  N farthest;  ///< largest |c|
  N sums[6];   ///< Σ w c^p

  /// Sets `farthest` from the first and last c of the direction.
  APSIS_FORMULA void set_ends(N first, N last) { farthest = larger(absolute(first), absolute(last)); }
  APSIS_FORMULA N mean() const { return sums[1] / sums[0]; }
  APSIS_FORMULA N mean_square() const { return sums[2] / sums[0]; }

  /// Derivatives of ⟨c⟩ and ⟨c²⟩ by β and γ. The derivative of ⟨c²⟩ by β equals mean_by_gamma.
  struct slopes {
    N mean_by_beta, mean_by_gamma, square_by_gamma;
  };
  APSIS_FORMULA slopes differentiate() const {
    const N per_mass = N(1.0) / sums[0], c = sums[1] * per_mass, square = sums[2] * per_mass;
    return {square - c * c, sums[3] * per_mass - c * square, sums[4] * per_mass - square * square};
  }
  /// Returns a bound on |βc + γc²|.
  APSIS_FORMULA N largest_exponent(N beta, N gamma) const {
    return (absolute(beta) + absolute(gamma) * farthest) * farthest;
  }
};

/// Newton's method for ⟨c_k⟩ = 0 and Σ_k ⟨c_k²⟩ = d T, for one cell or for one in each lane of N. Steps
/// multiply weights by exponentials of small numbers. The caller changes the weights and sums them:
///   while (newton.advance()) for all k: w ← w exp(newton.beta[k] c + newton.gamma c²), newton.of[k].sums ← …
/// A cell that has ended keeps its weights, because its β and γ are 0.
template <class N>
struct nearby_newton {
  weighted_direction<N> of[3];  ///< weights of each direction
  int dimensions;               ///< number of directions
  N square, speed;              ///< d T, √T
  N beta[3], gamma;             ///< parameters of the next change
  N before;                     ///< defect before the last change
  int changes;                  ///< number of changes of the weights so far
  N running;                    ///< 1 where the next change matters, else 0
  N found;                      ///< 1 where the weights have the moments of the state, else 0

  /// Returns the start for a temperature T and its root. The caller then sets `of`.
  static APSIS_FORMULA nearby_newton start(int dimensions, N T, N speed) {
    nearby_newton newton;
    newton.dimensions = dimensions;
    newton.square = N(dimensions) * T;
    newton.speed = speed;
    newton.before = N(__builtin_huge_val());
    newton.changes = 0;
    newton.running = N(1.0);
    newton.found = N(0.0);
    return newton;
  }

  /// Returns true if the caller must change the weights of some cell. A cell ends if it has the moments, or
  /// if its next step is not small or Newton's method does not converge.
  APSIS_FORMULA bool advance() {
    constexpr double rounding = 4.5e-16;  // two roundings
    constexpr double close = 1e-13;       // rounding may keep sums of a few dozen terms at this distance
    constexpr int most_changes = 8;
    if (changes == most_changes) return false;
    const N none(0.0), size = defect();
    const N stays = select(size < N(0.5) * before, none, running);
    const N reached = select(size < N(rounding), running, select(size < N(close), stays, none));
    found = found + reached;
    running = select(size < before, running - reached, none);
    if (!any<N>(running > none)) return false;
    before = size;
    ++changes;
    find_change();
    return any<N>(running > none);
  }

  /// Returns the product of the masses of all directions.
  APSIS_FORMULA N mass() const {
    N product(1.0);
    for (int k = 0; k < dimensions; ++k) product = product * of[k].sums[0];
    return product;
  }

 private:
  APSIS_FORMULA N missing_square() const {
    N rest = square;
    for (int k = 0; k < dimensions; ++k) rest = rest - of[k].mean_square();
    return rest;
  }

  /// Returns the largest relative residual; NaN without mass.
  APSIS_FORMULA N defect() const {
    N largest = absolute(missing_square()) / square;
    for (int k = 0; k < dimensions; ++k) {
      const N h = absolute(of[k].mean()) / speed;
      largest = select(h < largest, largest, h);
    }
    return largest;
  }

  /// Computes β_k and γ, with the β_k eliminated from the equation of the energy. Where the step is not
  /// small, the cell ends.
  APSIS_FORMULA void find_change() {
    const N none(0.0);
    N means[3], by_gamma[3];  // in units of the slope by β
    N rest = missing_square(), slope(0.0);
    for (int k = 0; k < dimensions; ++k) {
      const auto by = of[k].differentiate();
      means[k] = of[k].mean() / by.mean_by_beta;
      by_gamma[k] = by.mean_by_gamma / by.mean_by_beta;
      rest = rest + by.mean_by_gamma * means[k];
      slope = slope + (by.square_by_gamma - by.mean_by_gamma * by_gamma[k]);
    }
    gamma = rest / slope;
    for (int k = 0; k < dimensions; ++k) {
      beta[k] = -means[k] - by_gamma[k] * gamma;
      running = select(of[k].largest_exponent(beta[k], gamma) < N(small_exponent), running, none);
    }
    gamma = select(running > none, gamma, none);
    for (int k = 0; k < dimensions; ++k) beta[k] = select(running > none, beta[k], none);
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
