#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/steady/sweep_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/steady/sweep_rows.hpp>

#include <apsis/steady/formulas/sweep.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using sweep_rows::rotation;
using sweep_rows::strip;
using sweep_rows::upstream;

template <std::size_t directions, bool turns>
void solve_along(const upstream* terms, const std::array<const double*, 3>& lambda, double rate,
                 const rotation& turn, std::span<const strip> strips, double* row) {
  using N = pack<wide>;
  const int length = static_cast<int>(hn::Lanes(wide()));
  // Local copies show the compiler that storing the row does not change them.
  std::array<upstream, directions> from;
  std::array<const double*, directions> speed;
  for (std::size_t d = 0; d < directions; ++d) {
    from[d] = terms[d];
    speed[d] = lambda[d];
  }
  const double *out = turn.out, *in = turn.in;
  const N per_radius(turn.per_radius);
  for (const strip components : strips)
    for (int k = components.begin; k < components.end; k += length) {
      const int count = std::min(length, components.end - k);
      upwind_equation<N> equation(load_some(row + k, count), N(rate));
      for (std::size_t d = 0; d < directions; ++d)
        equation.add(load_some(speed[d] + k, count), N(from[d].here), N(from[d].first),
                     load_some(from[d].one + k, count), N(from[d].second), load_some(from[d].two + k, count));
      if constexpr (turns)
        equation.add_rotation(per_radius * load_some(out + k, count), per_radius * load_some(in + k, count),
                              load_some(row + k + components.upstream, count));
      store_some(equation.solution(), count, row + k);
    }
}

template <bool turns>
void solve_for(std::span<const upstream> terms, const std::array<const double*, 3>& lambda, double rate,
               const rotation& turn, std::span<const strip> strips, double* row) {
  const auto solved = terms.size() == 1   ? &solve_along<1, turns>
                      : terms.size() == 2 ? &solve_along<2, turns>
                                          : &solve_along<3, turns>;
  solved(terms.data(), lambda, rate, turn, strips, row);
}

void solve(std::span<const upstream> terms, const std::array<const double*, 3>& lambda, double rate,
           const rotation& turn, std::span<const strip> strips, double* row) {
  const auto solved = turn.out == nullptr ? &solve_for<false> : &solve_for<true>;
  solved(terms, lambda, rate, turn, strips, row);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(solve);
}  // namespace

void sweep_rows::solve(std::span<const upstream> terms, const std::array<const double*, 3>& lambda,
                       double rate, const rotation& turn, std::span<const strip> strips, double* row) {
  HWY_DYNAMIC_DISPATCH(solve)(terms, lambda, rate, turn, strips, row);
}

}  // namespace apsis
#endif
