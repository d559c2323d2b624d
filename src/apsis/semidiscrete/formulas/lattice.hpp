// The formulas of semidiscrete/lattice_rows.hpp.
#if defined(APSIS_SEMIDISCRETE_FORMULAS_LATTICE) == defined(HWY_TARGET_TOGGLE)
#ifdef APSIS_SEMIDISCRETE_FORMULAS_LATTICE
#undef APSIS_SEMIDISCRETE_FORMULAS_LATTICE
#else
#define APSIS_SEMIDISCRETE_FORMULAS_LATTICE
#endif

#include <apsis/exec/number.hpp>
#include <apsis/scheme/formulas/upwind.hpp>
#include <apsis/semidiscrete/formulas/upwind.hpp>

APSIS_BEFORE_FORMULAS();
namespace apsis::APSIS_NUMBERS {

/// Returns acc + β change, but 0 for results between −2^−1022 and 0: there two roundings of subnormal numbers
/// exceed the value.
template <class N>
APSIS_FORMULA N with_change(N acc, N beta, N change) {
  const N sum = acc + beta * change;
  return select(sum < N(0.0), select(sum > N(-0x1p-1022), N(0.0), sum), sum);
}

/// Five neighbouring values in the direction of motion, and the edge downstream of the middle one. Points
/// beyond the ends have the values of a vacuum.
template <bool FifthOrder, class N, class Values>
struct edge_window {
  const Values& values;
  N a, b, c, d, e;

  explicit APSIS_FORMULA edge_window(const Values& of)
      : values(of), a(0.0), b(0.0), c(of(0)), d(of(1)), e(of(2)) {}
  APSIS_FORMULA N value() const { return c; }
  APSIS_FORMULA N edge() const {
    if constexpr (FifthOrder) return upwind5_edge(a, b, c, d, e);
    return upwind1_edge(c);
  }
  /// Moves to point j.
  APSIS_FORMULA void advance_to(int j) {
    a = b;
    b = c;
    c = d;
    d = e;
    e = values(j + 2);
  }
};

/// Computes limited fluxes between neighbouring points, as between cells.
template <class N, class Window>
struct limited_walk {
  Window& window;
  N inverse_cfl;
  limited_cell<N> here;

  APSIS_FORMULA limited_walk(Window& of, N inverse)
      : window(of),
        inverse_cfl(inverse),
        here(limited_after(unlimited(N(0.0), N(0.0), inverse), of.value(), of.edge(), inverse)) {}
  /// Moves from point j − 1 to point j, and returns the flux out of point j − 1.
  APSIS_FORMULA N to(int j) {
    window.advance_to(j);
    const auto after = limited_after(here, window.value(), window.edge(), inverse_cfl);
    const N out = limited_flux(here, after);
    here = after;
    return out;
  }
};

/// Computes fluxes that are the edge values, without a limiter.
template <class N, class Window>
struct plain_walk {
  Window& window;
  N here;

  APSIS_FORMULA plain_walk(Window& of, N) : window(of), here(of.edge()) {}
  APSIS_FORMULA N to(int j) {
    window.advance_to(j);
    const N out = here;
    here = window.edge();
    return out;
  }
};

/// Calls put(flux into the point − flux out) for all points of a line in the direction of motion. The window
/// has the values of the points. Nothing leaves the last point. Returns the flux into the last point.
template <class Walk, class Window, class N, class Put>
APSIS_FORMULA N walk_along(Window& window, int points, N inverse_cfl, const Put& put) {
  Walk fluxes(window, inverse_cfl);
  N in(0.0);
  for (int j = 1; j < points; ++j) {
    const N out = fluxes.to(j);
    put(in - out);
    in = out;
  }
  put(in - N(0.0));
  return in;
}

/// Calls walk_along() with fluxes of first or fifth order, limited or not; values(j) is the value of point j.
template <bool Limited, bool FifthOrder, class N, class Values, class Put>
APSIS_FORMULA N add_fluxes(const Values& values, int points, N inverse_cfl, const Put& put) {
  edge_window<FifthOrder, N, Values> window(values);
  using seen = edge_window<FifthOrder, N, Values>;
  if constexpr (Limited) return walk_along<limited_walk<N, seen>>(window, points, inverse_cfl, put);
  return walk_along<plain_walk<N, seen>>(window, points, inverse_cfl, put);
}

}  // namespace apsis::APSIS_NUMBERS
APSIS_AFTER_FORMULAS();

#endif
