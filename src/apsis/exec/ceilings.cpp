#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/exec/ceilings.cpp"
#include <hwy/foreach_target.h>

#include <apsis/exec/ceilings.hpp>

#include <apsis/exec/aligned.hpp>
#include <apsis/exec/simd-inl.hpp>
#include <apsis/exec/thread_clock.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void triad(const double* b, const double* c, double s, std::size_t count, double* a) {
  using N = pack<wide>;
  const auto length = hn::Lanes(wide());
  std::size_t k = 0;
  for (; k + length <= count; k += length) fma(N(s), N::load(c + k), N::load(b + k)).store(a + k);
  for (; k < count; ++k) a[k] = b[k] + s * c[k];
}

constexpr int chains = 16;

/// Applies one multiply–add to each number. The pack expansion unrolls the loop, so that all numbers stay in
/// registers independently of the optimizer.
template <class N, std::size_t... K>
HWY_INLINE void advance(N (&x)[chains], N factor, N addend, std::index_sequence<K...>) {
  ((x[K] = fma(x[K], factor, addend)), ...);
}

/// Executes `rounds` × `chains` multiply–adds of packs in independent chains. Returns the sum of the chains,
/// so that the compiler cannot remove any.
double multiply_adds(long rounds) {
  using N = pack<wide>;
  const N factor(0.999999), addend(1e-6);
  N x[chains] = {N(1.0), N(1.1), N(1.2), N(1.3), N(1.4), N(1.5), N(1.6), N(1.7),
                 N(1.8), N(1.9), N(2.0), N(2.1), N(2.2), N(2.3), N(2.4), N(2.5)};
  for (long round = 0; round < rounds; ++round)
    advance(x, factor, addend, std::make_index_sequence<chains>());
  N sum = x[0];
  for (int k = 1; k < chains; ++k) sum = sum + x[k];
  return hn::GetLane(hn::SumOfLanes(wide(), sum.v));
}

int multiply_adds_per_round() {
  return chains * static_cast<int>(hn::Lanes(wide()));
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {

HWY_EXPORT(triad);
HWY_EXPORT(multiply_adds);
HWY_EXPORT(multiply_adds_per_round);

constexpr int attempts = 20;

}  // namespace

double triad_bytes_per_second(std::size_t count) {
  aligned_vector<double> a(count, 0.0), b(count, 1.0), c(count, 2.0);
  const std::size_t sweeps = std::max<std::size_t>(1, (std::size_t{1} << 20) / count);
  double best = 0.0;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const double start = thread_seconds();
    for (std::size_t sweep = 0; sweep < sweeps; ++sweep)
      HWY_DYNAMIC_DISPATCH(triad)(b.data(), c.data(), 1.0 + 1e-9 * static_cast<double>(sweep), count,
                                  a.data());
    best = std::max(best, 24.0 * static_cast<double>(count * sweeps) / (thread_seconds() - start));
  }
  return best;
}

double seconds_of_multiply_adds(double count) {
  const int each = HWY_DYNAMIC_DISPATCH(multiply_adds_per_round)();
  volatile double keep = 0.0;
  const double start = thread_seconds();
  keep = HWY_DYNAMIC_DISPATCH(multiply_adds)(static_cast<long>(count / each));
  static_cast<void>(keep);
  return thread_seconds() - start;
}

double multiply_adds_per_second() {
  constexpr double count = 1e7;
  double best = 0.0;
  for (int attempt = 0; attempt < attempts; ++attempt)
    best = std::max(best, count / seconds_of_multiply_adds(count));
  return best;
}

}  // namespace apsis
#endif
