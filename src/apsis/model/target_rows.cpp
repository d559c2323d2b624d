#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/target_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/target_rows.hpp>

#include <apsis/exec/octet-inl.hpp>
#include <apsis/model/formulas/target.hpp>
#include <apsis/model/formulas/target_moments.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using target_rows::lines_of_row;

/// The polynomials on eight lines, one in each lane.
struct eight_polynomials {
  alignas(64) double k0[most_lanes], k1[most_lanes], k2[most_lanes], k3[most_lanes];
  alignas(64) double least[most_lanes];  ///< a lower bound of P, far above rounding where it is positive
  bool all_positive;                     ///< whether all these bounds are positive

  template <int D, bool Cubic>
  HWY_INLINE void find(const target_polynomial& p, const lines_of_row& of, int first) {
    constexpr octet_group eight;
    octet c[2] = {0.0, 0.0};
    for (int k = 0; k + 1 < D; ++k)
      c[k] = eight.load(of.v_across[k] + first, of.count - first) - octet(of.u_across[k]);
    const auto on_lines = polynomial_on_line<D, Cubic>(p, of.across, of.last, c);
    on_lines.k0.store(k0);
    on_lines.k1.store(k1);
    on_lines.k2.store(k2);
    on_lines.k3.store(k3);
    const octet end(std::max(std::abs(of.v[0] - of.u), std::abs(of.v[of.n - 1] - of.u)));
    const octet terms =
        fma(fma(absolute(on_lines.k3), end, larger(-on_lines.k2, octet(0.0))), end, absolute(on_lines.k1)) *
        end;
    constexpr double clear = 1.0 - 1e-3;
    const octet rest = octet(clear) * on_lines.k0 - terms;
    rest.store(least);
    all_positive = all<octet>(rest > octet(0.0));
  }
};

/// Weighs eight lines of n velocities v without bounds. Lines are the inner loop, because few velocities per
/// line would leave the processor waiting for the ends of loops.
template <bool Cubic>
HWY_INLINE void weigh_eight(const double* m, const eight_polynomials& p, const double* v, pack<wide> u, int n,
                            double* e) {
  using N = pack<wide>;
  const int length = static_cast<int>(hn::Lanes(wide()));
  const auto value = [&](int line, N c, N of_m) APSIS_PACKED {
    // With k3 = 0 the first step gives k2.
    const N k2(p.k2[line]), leading = Cubic ? fma(N(p.k3[line]), c, k2) : k2;
    return of_m * fma(fma(leading, c, N(p.k1[line])), c, N(p.k0[line]));
  };
  int k = 0;
  for (; k + length <= n; k += length) {
    const N c = N::load(v + k) - u;
    for (int line = 0; line < most_lanes; ++line) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(line) * n + k;
      value(line, c, N::load(m + at)).store(e + at);
    }
  }
  if (const int count = n - k; count > 0) {
    const N c = load_some(v + k, count) - u;
    for (int line = 0; line < most_lanes; ++line) {
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(line) * n + k;
      store_some(value(line, c, load_some(m + at, count)), count, e + at);
    }
  }
}

/// Weighs one line, whose values are bounded if `Bounded`. Its velocities are v.
template <bool Bounded>
HWY_INLINE bool weigh_line(const double* m, const cubic_polynomial<pack<wide>>& p, const double* v,
                           pack<wide> u, int n, const double* f, pack<wide> keep, double* e) {
  using N = pack<wide>;
  const int length = static_cast<int>(hn::Lanes(wide()));
  bool raised = false;
  int k = 0;
  for (; k + length <= n; k += length) {
    N value = N::load(m + k) * p(N::load(v + k) - u);
    if constexpr (Bounded) raised |= raise(value, keep, N::load(f + k));
    value.store(e + k);
  }
  if (const int count = n - k; count > 0) {
    N value = load_some(m + k, count) * p(load_some(v + k, count) - u);
    if constexpr (Bounded) raised |= raise(value, keep, load_some(f + k, count));
    store_some(value, count, e + k);
  }
  return raised;
}

bool is_nonnegative(const double* f, long n) {
  using N = pack<wide>;
  const long length = static_cast<long>(hn::Lanes(wide()));
  N least(0.0);
  long k = 0;
  for (; k + length <= n; k += length) least = minimum(least, N::load(f + k));
  if (k < n) least = minimum(least, load_some(f + k, static_cast<int>(n - k)));
  return !any<N>(least < N(0.0));
}

template <int D, bool Cubic>
HWY_INLINE bool weigh_lines(const double* m, const target_polynomial& p, const lines_of_row& of,
                            const double* f, double keep, double* e) {
  using N = pack<wide>;
  const bool bounded = keep < std::numeric_limits<double>::infinity();  // ∞ · 0 is NaN
  // Copies, because stores to e might change their originals.
  const int n = of.n, lines = of.count;
  const double* const v = of.v;
  const N u(of.u), kept(keep);
  // Positive values of e are above the bounds −keep f unless f is negative somewhere.
  const bool positive_is_enough = !bounded || is_nonnegative(f, of.size());
  bool raised = false;
  eight_polynomials all;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (int first = 0; first < lines; first += most_lanes) {
    all.find<D, Cubic>(p, of, first);
    const int some = std::min(most_lanes, lines - first);
    if (some == most_lanes && (!bounded || (positive_is_enough && all.all_positive))) {
      weigh_eight<Cubic>(m, all, v, u, n, e);
      m += most_lanes * n;
      f += most_lanes * n;
      e += most_lanes * n;
      continue;
    }
    for (int line = 0; line < some; ++line, m += n, f += n, e += n) {
      const cubic_polynomial<N> on_line{N(all.k0[line]), N(all.k1[line]), N(all.k2[line]), N(all.k3[line])};
      if (bounded && !(positive_is_enough && all.least[line] > 0.0)) {
        raised |= weigh_line<true>(m, on_line, v, u, n, f, kept, e);
      } else {
        weigh_line<false>(m, on_line, v, u, n, f, kept, e);
      }
    }
  }
  return raised;
}

template <int D>
bool weigh_row(const double* m, const target_polynomial& p, const lines_of_row& of, const double* f,
               double keep, double* e) {
  return p.is_quadratic() ? weigh_lines<D, false>(m, p, of, f, keep, e)
                          : weigh_lines<D, true>(m, p, of, f, keep, e);
}

bool weigh(const double* m, const target_polynomial& p, const lines_of_row& of, const double* f, double keep,
           double* e) {
  switch (of.dimensions) {
    case 1:
      return weigh_row<1>(m, p, of, f, keep, e);
    case 2:
      return weigh_row<2>(m, p, of, f, keep, e);
    default:
      return weigh_row<3>(m, p, of, f, keep, e);
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(weigh);
}  // namespace

bool target_rows::weigh(const double* m, const target_polynomial& p, const lines_of_row& of, const double* f,
                        double keep, double* e) {
  return HWY_DYNAMIC_DISPATCH(weigh)(m, p, of, f, keep, e);
}

}  // namespace apsis
#endif
