// The formulas of model/line_sums.hpp and model/line_powers.hpp.
#if defined(APSIS_MODEL_FORMULAS_LINE) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_MODEL_FORMULAS_LINE
#undef APSIS_MODEL_FORMULAS_LINE
#else
#define APSIS_MODEL_FORMULAS_LINE
#endif

#include <apsis/exec/number.hpp>
#include <apsis/model/formulas/exponential.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Returns exp(βx − τc − shift), at most e^691; values below 1e−300 become 0. Products are not fused, so that
/// weights do not depend on the instruction set.
template <class N>
APSIS_FORMULA N line_weight(N x, N c, N beta, N tau, N shift) {
  const N limit(691.0), exponent = beta * x - tau * c - shift;
  const N weight = exp_of(smaller(larger(exponent, -limit), limit));
  return select(weight > N(1e-300), weight, N(0.0));
}

/// The sums of line_sums::values.
template <class N>
struct sums_of_weights {
  N mass, above, below, energy;

  APSIS_FORMULA sums_of_weights() : mass(0.0), above(0.0), below(0.0), energy(0.0) {}
  APSIS_FORMULA void add(N weight, N x, N c) {
    mass = mass + weight;
    above = fma(weight, maximum(x, N(0.0)), above);
    below = fma(weight, maximum(-x, N(0.0)), below);
    energy = fma(weight, c, energy);
  }
};

/// The sums of line_sums::products.
template <class N>
struct sums_of_products {
  N above_x, above_c, below_x, below_c, cc;

  APSIS_FORMULA sums_of_products() : above_x(0.0), above_c(0.0), below_x(0.0), below_c(0.0), cc(0.0) {}
  APSIS_FORMULA void add(N weight, N x, N c) {
    const N up = weight * maximum(x, N(0.0)), down = weight * maximum(-x, N(0.0));
    above_x = fma(up, x, above_x);
    above_c = fma(up, c, above_c);
    below_x = fma(down, x, below_x);
    below_c = fma(down, c, below_c);
    cc = fma(weight * c, c, cc);
  }
};

/// Returns w e^(βc + γc²) for exponents of at most small_exponent.
template <class N>
APSIS_FORMULA N changed_weight(N w, N c, N beta, N gamma) {
  return w * exp_of_small(fma(gamma, c, beta) * c);
}

/// The sums Σ w c^p, p = 0 … 5.
template <class N>
struct sums_of_six_powers {
  N of[6];

  APSIS_FORMULA sums_of_six_powers() : of{N(0.0), N(0.0), N(0.0), N(0.0), N(0.0), N(0.0)} {}
  APSIS_FORMULA void add(N w, N c) {
    const N c2 = c * c, w2 = w * c2;
    of[0] = of[0] + w;
    of[1] = fma(w, c, of[1]);
    of[2] = of[2] + w2;
    of[3] = fma(w2, c, of[3]);
    of[4] = fma(w2, c2, of[4]);
    of[5] = fma(w2 * c2, c, of[5]);
  }
};

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
