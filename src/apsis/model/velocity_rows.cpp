#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/velocity_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/velocity_rows.hpp>

#include <apsis/core/simd-inl.hpp>

#include <algorithm>
#include <cmath>

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using N = pack<wide>;
constexpr int most_lanes = 8;

HWY_INLINE double total(N x) {
  return hn::GetLane(hn::SumOfLanes(wide(), x.v));
}

/// The first `count` numbers, all if there are more than a vector holds; zeros behind them.
HWY_INLINE N load_some(const double* from, int count) {
  if (count >= static_cast<int>(hn::Lanes(wide()))) return N::load(from);
  // Reads no more than that where a vector is longer than two.
  if constexpr (HWY_MAX_BYTES > 16)
    return N(hn::MaskedLoad(hn::FirstN(wide(), static_cast<std::size_t>(count)), wide(), from));
  alignas(64) double all[most_lanes] = {};
  std::copy_n(from, count, all);
  return N::load(all);
}

HWY_INLINE void store_some(N x, int count, double* to) {
  if (count >= static_cast<int>(hn::Lanes(wide()))) return x.store(to);
  hn::BlendedStore(x.v, hn::FirstN(wide(), static_cast<std::size_t>(count)), wide(), to);
}

velocity_rows::sums moments(const double* f, const double* v, const double* half_square, int n) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  // Two sums of each kind: an addition waits for the one before it.
  N mass[2] = {0.0, 0.0}, momentum[2] = {0.0, 0.0}, energy[2] = {0.0, 0.0};
  int j = 0;
  for (; j + 2 * length <= n; j += 2 * length)
    for (int half = 0; half < 2; ++half) {
      const int k = j + half * length;
      const N value = N::load(f + k);
      mass[half] = mass[half] + value;
      momentum[half] = fma(N::load(v + k), value, momentum[half]);
      energy[half] = fma(N::load(half_square + k), value, energy[half]);
    }
  for (; j < n; j += length) {
    const N value = load_some(f + j, n - j);
    mass[0] = mass[0] + value;
    momentum[0] = fma(load_some(v + j, n - j), value, momentum[0]);
    energy[0] = fma(load_some(half_square + j, n - j), value, energy[0]);
  }
  return {total(mass[0] + mass[1]), total(momentum[0] + momentum[1]), total(energy[0] + energy[1])};
}

double entropy(const double* f, int n) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  const auto term = [](N value)
                        APSIS_PACKED { return value * N(hn::Log(wide(), larger(value, N(1e-300)).v)); };
  N sum[2] = {0.0, 0.0};
  int j = 0;
  for (; j + 2 * length <= n; j += 2 * length)
    for (int half = 0; half < 2; ++half) sum[half] = sum[half] + term(N::load(f + j + half * length));
  for (; j < n; j += length) sum[0] = sum[0] + term(load_some(f + j, n - j));
  return total(sum[0] + sum[1]);
}

/// 0 below e^−690.
HWY_INLINE N exponential(N x) {
  const N lowest(-690.0);
  return select(x > lowest, N(hn::Exp(wide(), larger(x, lowest).v)), N(0.0));
}

/// v − u of vector k of the points.
HWY_INLINE N distances(const velocity_rows::points& line, double u, int k) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  return line.spacing * (N(hn::Iota(wide(), 0.0)) + N(k * length + 0.5 - 0.5 * line.n)) - N(u);
}

void gaussian_by_exponentials(const velocity_rows::points& line, double a, double u, double T, double* m) {
  const int length = static_cast<int>(hn::Lanes(wide())), vectors = (line.n + length - 1) / length;
  for (int k = 0; k < vectors; ++k) {
    const N x = distances(line, u, k);
    store_some(a * exponential(-(x * x) / N(2.0 * T)), line.n - k * length, m + k * length);
  }
}

/// A Gaussian seen from one vector of points: what the vectors to the right and to the left are multiplied
/// with.
struct outwards {
  N value, right, left, change;
};

/// With `Deep` some values leave the range of normal numbers.
template <bool Deep>
HWY_INLINE N moved(N value, N factor) {
  const N next = value * factor;
  if constexpr (Deep) return select(next > N(1e-300), next, N(0.0));
  return next;
}

template <bool Deep>
HWY_INLINE void fill(const outwards& from, int centre, int n, double* m) {
  const int length = static_cast<int>(hn::Lanes(wide()));
  N value = from.value, factor = from.right;
  int k = centre * length;
  for (; k + length <= n; k += length) {
    value.store(m + k);
    value = moved<Deep>(value, factor);
    factor = factor * from.change;
  }
  if (k < n) store_some(value, n - k, m + k);
  value = from.value;
  factor = from.left;
  for (k = (centre - 1) * length; k >= 0; k -= length) {
    value = moved<Deep>(value, factor);
    factor = factor * from.change;
    value.store(m + k);
  }
}

void gaussian(const velocity_rows::points& line, double a, double u, double T, double* m) {
  const int length = static_cast<int>(hn::Lanes(wide())), vectors = (line.n + length - 1) / length;
  const double at = (u / line.spacing + 0.5 * line.n) / length;
  const int centre = static_cast<int>(std::clamp(at, 0.0, vectors - 1.0));
  const double jump = line.spacing * length, per = 0.5 / T;
  // The factors are exponentials of up to three times this, whose rounding they have; and k vectors away a
  // value has k²/2 roundings of `change`, which may be many where the Gaussian is still large: at most one in
  // 5 times this.
  const double decay = jump * jump * per;
  if (!(decay > 0.02 && decay < 8.0)) return gaussian_by_exponentials(line, a, u, T, m);
  const N x = distances(line, u, centre);
  N value = a * exponential(-(x * x) * per);
  value = select(value > N(1e-300), value, N(0.0));
  const N right = exponential(-(2.0 * jump * x + jump * jump) * per),
          change = exponential(N(-2.0 * jump * jump * per));
  const outwards from{value, right, change / right, change};
  const double farthest = 0.5 * line.spacing * line.n + jump + std::abs(u);
  if (farthest * farthest * per < 600.0 && a > 1e-30) {
    fill<false>(from, centre, line.n, m);
  } else {
    fill<true>(from, centre, line.n, m);
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(moments);
HWY_EXPORT(entropy);
HWY_EXPORT(gaussian);
}  // namespace

velocity_rows::sums velocity_rows::moments(const double* f, const double* v, const double* half_square,
                                           int n) {
  return HWY_DYNAMIC_DISPATCH(moments)(f, v, half_square, n);
}

double velocity_rows::entropy(const double* f, int n) {
  return HWY_DYNAMIC_DISPATCH(entropy)(f, n);
}

void velocity_rows::gaussian(const points& line, double a, double u, double T, double* m) {
  HWY_DYNAMIC_DISPATCH(gaussian)(line, a, u, T, m);
}

}  // namespace apsis
#endif
