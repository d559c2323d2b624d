// The formulas of semidiscrete/rotation_rows.hpp.
#if defined(APSIS_SEMIDISCRETE_FORMULAS_ROTATION) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SEMIDISCRETE_FORMULAS_ROTATION
#undef APSIS_SEMIDISCRETE_FORMULAS_ROTATION
#else
#define APSIS_SEMIDISCRETE_FORMULAS_ROTATION
#endif

#include <apsis/exec/number.hpp>
#include <apsis/semidiscrete/formulas/upwind.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Fluxes out of an angle, of first order and from the reconstruction.
template <class N>
struct rotation_fluxes {
  N low_order, high_order;

  APSIS_FORMULA N correction() const { return high_order - low_order; }
};

/// The edge between two angles, downstream of one of them: the speed s |sin ω| and the slope Δω cos ω.
template <class N>
struct rotation_edge {
  N speed, slope;
};

/// Factors of the derivatives in the flux of fifth order for angles with the distance Δω. They multiply Δω
/// ∂F, Δω³ ∂³F, and Δω² ∂²F times `speed`.
struct rotation_factors {
  double first, third, second;
};

/// Returns the fluxes out of the angle c of five angles in the direction of motion; d and e lie downstream.
template <class N>
APSIS_FORMULA rotation_fluxes<N> fluxes_of_rotation(const rotation_edge<N>& edge,
                                                    const rotation_factors& factors, bool fifth_order, N a,
                                                    N b, N c, N d, N e) {
  const N low = edge.speed * upwind1_edge(c);
  if (!fifth_order) return {low, low};
  const N first = d - c, outer = e - b, third = fma(N(-3.0), first, outer);
  const N second = N(0.5) * ((b - c) + (e - d));
  const N along = fma(N(factors.first), first, N(factors.third) * third);
  const N upwind = fma(N(factors.second), second, upwind5_edge(a, b, c, d, e));
  return {low, fma(edge.slope, along, edge.speed * upwind)};
}

/// Returns the fraction of the corrections that leaves a value u ≥ 0 nonnegative, u − τ (out − in) ≥ 0 with
/// `inverse` = 1/τ. Unlike in limited_fraction(), edges may have different speeds.
template <class N>
APSIS_FORMULA N fraction_of_rotation(const rotation_fluxes<N>& in, const rotation_fluxes<N>& out, N u,
                                     N inverse) {
  return limited_fraction(in.low_order, out.low_order, u, in.correction(), out.correction(), inverse);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
