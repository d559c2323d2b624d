#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/upwind_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/upwind_rows.hpp>

#include <apsis/exec/counted.hpp>
#include <apsis/scheme/walk-inl.hpp>
#include <apsis/semidiscrete/formulas/upwind.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

using upwind::cells;
using upwind::row_target;

template <class Walk, class N = typename Walk::number>
HWY_INLINE N outflow(const Walk& way, const cells& run, int j) {
  return way.load_downstream(run.left, run.right, run.pitch, j);
}

/// The factors λ = β|v|/Δx of a pack of velocities for all targets, which are the same in all cells.
template <class N>
class step_factors {
 public:
  HWY_INLINE step_factors(std::span<const row_target> targets, N speed) : speed_(speed) {
    for (std::size_t k = 0; k < std::min(targets.size(), kept); ++k)
      (N(targets[k].beta) * speed).store(factors_ + longest * k);
  }
  HWY_INLINE N of(std::span<const row_target> targets, std::size_t k) const {
    return k < kept ? N::load(factors_ + longest * k) : N(targets[k].beta) * speed_;
  }

 private:
  static constexpr std::size_t kept = 16, longest = 8;  ///< a pack has at most 512 bits
  alignas(64) double factors_[kept * longest];
  N speed_;
};

template <class Walk, class N = typename Walk::number>
HWY_INLINE void accumulate(const Walk& way, const cells& run, std::span<const row_target> targets,
                           const step_factors<N>& factors, int j, N u, N difference) {
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const auto& to = targets[k];
    way.prefetch(to.acc, to.pitch, j);
    const auto old = [&]() APSIS_PACKED { return way.load(to.acc, to.pitch, j); };
    const auto source = [&]() APSIS_PACKED { return way.load(run.source, run.pitch, j); };
    way.store(transported(N(to.alpha), u, factors.of(targets, k), difference, to.fresh, old,
                          run.source != nullptr, N(to.beta), source),
              to.acc, to.pitch, j);
  }
}

/// Stores a pack in its row unless the row is null.
template <class Walk, class N = typename Walk::number>
HWY_INLINE void store_row(const Walk& way, N value, double* row) {
  if (row != nullptr) way.store(value, row, 0, 0);
}

template <class Walk, class N = typename Walk::number>
HWY_INLINE void add_along(const Walk& way, N speed, const cells& run, std::span<const row_target> targets) {
  const step_factors<N> factors(targets, speed);
  N in = outflow(way, run, -1);
  store_row(way, in, run.in);
  for (int j = 0; j < run.count; ++j) {
    const N out = outflow(way, run, j);
    accumulate(way, run, targets, factors, j, way.load(run.u, j), in - out);
    in = out;
  }
  store_row(way, in, run.out);
}

void add(const cells& of, std::span<const row_target> targets) {
  const cells run = of;  // a copy, so that the compiler knows that storing targets does not change it
  for_walks(run.forward, run.count, run.width, [&](const auto& way, int k) APSIS_PACKED {
    using N = typename std::decay_t<decltype(way)>::number;
    add_along(way, N::load(run.per_cell + k), run, targets);
  });
}

template <class Walk, class N = typename Walk::number>
HWY_INLINE limited_cell<N> first_cell(const Walk& way, const cells& run, int j, N inverse_cfl) {
  return unlimited(way.load(run.u, j), outflow(way, run, j), inverse_cfl);
}

template <class Walk, class N = typename Walk::number>
HWY_INLINE limited_cell<N> next_cell(const Walk& way, const cells& run, int j, N inverse_cfl,
                                     const limited_cell<N>& upstream) {
  return limited_after(upstream, way.load(run.u, j), outflow(way, run, j), inverse_cfl);
}

template <class Walk, class N = typename Walk::number>
HWY_INLINE void add_limited_along(const Walk& way, N speed, N inverse_cfl, const cells& run,
                                  std::span<const row_target> targets) {
  const step_factors<N> factors(targets, speed);
  const auto before = next_cell(way, run, -1, inverse_cfl, first_cell(way, run, -2, inverse_cfl));
  auto here = next_cell(way, run, 0, inverse_cfl, before);
  N in = limited_flux(before, here);
  store_row(way, in, run.in);
  for (int j = 0; j < run.count; ++j) {
    const auto after = next_cell(way, run, j + 1, inverse_cfl, here);
    const N out = limited_flux(here, after);
    accumulate(way, run, targets, factors, j, here.u, in - out);
    here = after;
    in = out;
  }
  store_row(way, in, run.out);
}

void add_limited(const cells& of, std::span<const row_target> targets) {
  const cells run = of;  // a copy, so that the compiler knows that storing targets does not change it
  for_walks(run.forward, run.count, run.width, [&](const auto& way, int k) APSIS_PACKED {
    using N = typename std::decay_t<decltype(way)>::number;
    add_limited_along(way, N::load(run.per_cell + k), N::load(run.inverse_cfl + k), run, targets);
  });
}

/// Returns the operations per component for a run of cells.
double operations_of_run(bool limited, int cells_in_run) {
  cells run{};
  run.count = cells_in_run;
  return counted::operations_of([&] {
    if (limited) {
      add_limited_along(counting_walk(), counted(0.0), counted(1.0), run, {});
    } else {
      add_along(counting_walk(), counted(0.0), run, {});
    }
  });
}

void add_weights(const double* u, int width, std::span<const row_target> targets) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const N here = N::load(u + k);
    for (const auto& to : targets) {
      const N add = N(to.alpha) * here;
      (to.fresh ? add : N::load(to.acc + k) + add).store(to.acc + k);
    }
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(add);
HWY_EXPORT(add_limited);
HWY_EXPORT(add_weights);
}  // namespace

namespace upwind {

double operations(bool limited, int cells) {
  struct count {
    double first, further;
  };
  const auto counted_for = [](bool with_limiter) {
    const double one = HWY_NAMESPACE::operations_of_run(with_limiter, 1);
    return count{one, HWY_NAMESPACE::operations_of_run(with_limiter, 2) - one};
  };
  static const count with = counted_for(true), without = counted_for(false);
  const count& of = limited ? with : without;
  return of.further + (of.first - of.further) / cells;
}

void add(const cells& run, std::span<const row_target> targets) {
  HWY_DYNAMIC_DISPATCH(add)(run, targets);
}

void add_limited(const cells& run, std::span<const row_target> targets) {
  HWY_DYNAMIC_DISPATCH(add_limited)(run, targets);
}

void add_weights(const double* u, int width, std::span<const row_target> targets) {
  HWY_DYNAMIC_DISPATCH(add_weights)(u, width, targets);
}

}  // namespace upwind
}  // namespace apsis
#endif
