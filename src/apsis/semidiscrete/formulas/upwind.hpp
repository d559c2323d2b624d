// Upwind fluxes between cells seen in the direction of motion.
#if defined(APSIS_SEMIDISCRETE_FORMULAS_UPWIND) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SEMIDISCRETE_FORMULAS_UPWIND
#undef APSIS_SEMIDISCRETE_FORMULAS_UPWIND
#else
#define APSIS_SEMIDISCRETE_FORMULAS_UPWIND
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/formulas/limiter.hpp>
#include <apsis/scheme/formulas/upwind.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Returns αu + βT of a target, plus its content old() unless it is fresh, with T = |v|/Δx (in − out) +
/// source(). old() and source() are called only if they are needed. λ = β|v|/Δx is computed first, because
/// (|v|/Δx)(in − out) would round twice. Among subnormal numbers 2.5 units round like 3, and u − (in − out)
/// could become negative (docs/space.md, "Rounding").
template <class N, class Old, class Source>
APSIS_FORMULA N transported(N alpha, N u, N lambda, N difference, bool fresh, const Old& old, bool has_source,
                            N beta, const Source& source) {
  N sum = fresh ? alpha * u : fma(alpha, u, old());
  if (has_source) sum = fma(beta, source(), sum);
  return fma(lambda, difference, sum);
}

/// A cell and its outflow in the direction of motion, with the harmless fraction of its corrections.
template <class N>
struct limited_cell {
  N u, low_order, edge, fraction;
  bool moderate;  ///< the corrections of all components are small (limiter::is_moderate)
  bool harms;     ///< whether some component has a fraction below 1

  APSIS_FORMULA N correction() const { return edge - low_order; }
};

/// Returns a cell with unlimited corrections.
template <class N>
APSIS_FORMULA limited_cell<N> unlimited(N u, N edge, N inverse_cfl) {
  return {u, upwind1_edge(u), edge, N(1.0), limiter::is_moderate(u, edge, inverse_cfl), false};
}

/// Returns the cell downstream of another one, with its fraction of the corrections.
template <class N>
APSIS_FORMULA limited_cell<N> limited_after(const limited_cell<N>& upstream, N u, N edge, N inverse_cfl) {
  limited_cell<N> cell = unlimited(u, edge, inverse_cfl);
  if (cell.moderate && upstream.moderate) return cell;
  const limiter::harm_bound<N> of(upstream.low_order, cell.low_order, u, upstream.correction(),
                                  cell.correction(), inverse_cfl);
  cell.harms = of.exceeded();
  if (cell.harms) cell.fraction = of.fraction();
  return cell;
}

/// Returns the flux out of a cell, from its edge value and the fractions of the correction for this cell and
/// the next one.
template <class N>
APSIS_FORMULA N limited_edge(N low_order, N edge, N of_donor, N of_receiver) {
  const N correction = edge - low_order;
  const N fraction = select(correction > N(0.0), of_donor, of_receiver);
  return select(fraction < N(1.0), fma(fraction, correction, low_order), edge);
}

/// Returns the flux from `donor` to `receiver`.
template <class N>
APSIS_FORMULA N limited_flux(const limited_cell<N>& donor, const limited_cell<N>& receiver) {
  if (!donor.harms && !receiver.harms) return donor.edge;
  return limited_edge(donor.low_order, donor.edge, donor.fraction, receiver.fraction);
}

/// Returns the fraction of limited_after() from low-order edges and corrections, even if these are moderate.
template <class N>
APSIS_FORMULA N limited_fraction(N low_order_up, N low_order, N u, N a_in, N a_out, N inverse_cfl) {
  const limiter::harm_bound<N> of(low_order_up, low_order, u, a_in, a_out, inverse_cfl);
  return of.exceeded() ? of.fraction() : N(1.0);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
