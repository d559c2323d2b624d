#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/rotation_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/rotation_rows.hpp>

#include <apsis/semidiscrete/formulas/rotation.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

/// Finds the fluxes out of every angle of a half.
void find_rotation_fluxes(const rotation_rows::half& of, const rotation_rows::flux_rule& rule,
                          const double* values, const rotation_rows::places& to) {
  const int step = of.downstream(), apart = of.apart;
  const double *from = values + rotation_rows::halo * apart + of.first(), *speeds = rule.speeds;
  double *low_order = to.low_order + apart, *fluxes = to.fluxes + apart;
  const bool fifth_order = rule.fifth_order;
  for_packs(of.count(), [=](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const auto value = [=](int i) APSIS_PACKED { return N::load(from + k + i * step); };
    const auto out = fluxes_of_rotation(N::load(speeds + k), fifth_order, value(-2), value(-1), value(0),
                                        value(1), value(2));
    out.low_order.store(low_order + k);
    out.high_order.store(fluxes + k);
  });
}

void limit_rotation(const rotation_rows::half& of, const rotation_rows::flux_rule& rule, const double* values,
                    const rotation_rows::places& to) {
  const int step = of.downstream(), apart = of.apart;
  const double *from = values + rotation_rows::halo * apart + of.first(), *inverse = rule.inverse,
               *low_order = to.low_order + apart, *fluxes = to.fluxes + apart;
  double *fractions = to.fractions + apart, *limited = to.limited_fluxes + apart;
  const double scale = rule.scale;
  for_packs(of.count(), [=](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const auto out_of = [=](int place) APSIS_PACKED {
      return rotation_fluxes<N>{N::load(low_order + place), N::load(fluxes + place)};
    };
    fraction_of_rotation(out_of(k - step), out_of(k), N::load(from + k), N(scale) * N::load(inverse + k))
        .store(fractions + k);
  });
  for_packs(of.count(), [=](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    limited_edge(N::load(low_order + k), N::load(fluxes + k), N::load(fractions + k),
                 N::load(fractions + k + step))
        .store(limited + k);
  });
}

void turn(const rotation_rows::half& of, const rotation_rows::flux_rule& rule, const double* values,
          double rate, const rotation_rows::places& to, double* change) {
  find_rotation_fluxes(of, rule, values, to);
  if (rule.limited) limit_rotation(of, rule, values, to);
  const double* out = (rule.limited ? to.limited_fluxes : to.fluxes) + of.apart;
  const int step = of.downstream();
  for_packs(of.count(), [=](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    (N(rate) * (N::load(out + k - step) - N::load(out + k))).store(change + k);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(turn);
}  // namespace

namespace rotation_rows {

void continue_ring(const double* ring, int angles, int apart, double* values) {
  const int n = angles * apart, beyond = halo * apart;
  std::copy_n(ring + n - beyond, beyond, values);
  std::copy_n(ring, n, values + beyond);
  std::copy_n(ring, beyond, values + beyond + n);
}

void turn(const half& of, const flux_rule& rule, const double* values, double rate, const places& to,
          double* change) {
  HWY_DYNAMIC_DISPATCH(turn)(of, rule, values, rate, to, change);
}

}  // namespace rotation_rows
}  // namespace apsis
#endif
