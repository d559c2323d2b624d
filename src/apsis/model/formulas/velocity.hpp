// The formulas of model/velocity_rows.hpp.
#if defined(APSIS_MODEL_FORMULAS_VELOCITY) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_VELOCITY
#undef APSIS_MODEL_FORMULAS_VELOCITY
#else
#define APSIS_MODEL_FORMULAS_VELOCITY
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/formulas/exponential.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Sums over the velocities of a row: Σ f, Σ v f, Σ ½v² f.
template <class N>
struct sums_of_moments {
  N mass, momentum, energy;

  APSIS_FORMULA sums_of_moments() : mass(0.0), momentum(0.0), energy(0.0) {}
  APSIS_FORMULA void add(N value, N v, N half_square) {
    mass = mass + value;
    momentum = fma(v, value, momentum);
    energy = fma(half_square, value, energy);
  }
};

/// Returns e^x; 0 for x ≤ −690.
template <class N>
APSIS_FORMULA N exp_or_zero(N x) {
  const N lowest(-690.0);
  return select(x > lowest, exp_of(larger(x, lowest)), N(0.0));
}

/// Returns v_j − u for points v_j = Δv j, where j may be a half-integer.
template <class N>
APSIS_FORMULA N distance_to(N u, N spacing, N j) {
  return spacing * j - u;
}

/// These functions compute the terms of a recursion for a Gaussian on vectors of points, J = jump apart. Let
/// x be the distances v − u of one vector and per = 1/(2T). The next vector has the values exp(−(x +
/// J)²/(2T)) = exp(−x²/(2T)) × right, right = exp(−(2xJ + J²)/(2T)). From vector to vector, `right` changes
/// by the factor change = exp(−J²/T).
template <class N>
APSIS_FORMULA N gaussian_start(N a, N x, N per) {
  const N value = a * exp_or_zero(-(x * x) * per);
  return select(value > N(1e-300), value, N(0.0));
}
template <class N>
APSIS_FORMULA N gaussian_right(N x, N per, N jump) {
  return exp_or_zero(-(N(2.0) * jump * x + jump * jump) * per);
}
template <class N>
APSIS_FORMULA N gaussian_change(N per, N jump) {
  return exp_or_zero(N(-2.0) * jump * jump * per);
}

/// Returns the vector at which the recursion starts: the one with the centre u, or the nearest one. A vector
/// has `length` of n points.
template <class N>
APSIS_FORMULA N gaussian_vector(N u, N spacing, N n, N length, N vectors) {
  const N at = (u / spacing + N(0.5) * n) / length;
  return truncated(smaller(larger(at, N(0.0)), vectors - N(1.0)));
}

/// Whether the recursion is accurate and saves exponentials. It needs the exponentials of two vectors. Their
/// exponents are at most three times `decay` = J²/(2T), which bounds their rounding. A value k vectors away
/// has k²/2 roundings of `change`. With a small `decay` these would be many where the Gaussian is still
/// large; the lower bound allows five vectors per thermal speed √T.
APSIS_FORMULA bool gaussian_recurs(double decay, int vectors) {
  return vectors > 2 && decay > 0.02 && decay < 8.0;
}

/// Whether some values may leave the range of normal numbers. `farthest` is a bound on |x| + J.
APSIS_FORMULA bool gaussian_is_deep(double a, double farthest, double per) {
  return !(farthest * farthest * per < 600.0 && a > 1e-30);
}

/// A walk outwards over the vectors of a Gaussian. `factor` is `right`, or change/right on the way to the
/// left. With `Deep`, values that leave the range of normal numbers become 0.
template <bool Deep, class N>
struct gaussian_walk {
  N value, factor, change;

  APSIS_FORMULA void advance() {
    value = value * factor;
    if constexpr (Deep) value = select(value > N(1e-300), value, N(0.0));
    factor = factor * change;
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
