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

/// Returns sum + weight q. A quadrature point contributes weight q to Q of a cell.
template <class N>
APSIS_FORMULA N with_collision(N sum, N weight, N q) {
  return fma(weight, q, sum);
}

/// Returns αu + βQ, the contribution of a cell to a target.
template <class N>
APSIS_FORMULA N collision_part(N alpha, N u, N beta, N q) {
  // Omits an increment below the margin. Its rounding error, half of 4.9e-324, may exceed the remainder of a
  // subnormal number, which would become negative.
  const N increment = beta * q;
  return fma(alpha, u, select(absolute(increment) < N(apsis::limiter::absolute_margin), N(0.0), increment));
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
