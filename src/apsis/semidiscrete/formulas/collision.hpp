#if defined(APSIS_SEMIDISCRETE_FORMULAS_COLLISION) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SEMIDISCRETE_FORMULAS_COLLISION
#undef APSIS_SEMIDISCRETE_FORMULAS_COLLISION
#else
#define APSIS_SEMIDISCRETE_FORMULAS_COLLISION
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/limiter.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// sum + weight q, the part of a quadrature point in Q of a cell.
template <class N>
APSIS_FORMULA N with_collision(N sum, N weight, N q) {
  return fma(weight, q, sum);
}

/// αu + βQ, the part of a cell in a target.
template <class N>
APSIS_FORMULA N collision_part(N alpha, N u, N beta, N q) {
  // An increment below the margin is dropped: its rounding error, half of 4.9e-324, may exceed what it
  // leaves of a subnormal number, which would become negative.
  const N increment = beta * q;
  return fma(alpha, u, select(absolute(increment) < N(apsis::limiter::absolute_margin), N(0.0), increment));
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
