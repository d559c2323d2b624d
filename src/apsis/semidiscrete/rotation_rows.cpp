#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/rotation_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/rotation_rows.hpp>

#include <apsis/semidiscrete/formulas/rotation.hpp>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

/// Half of a ring. Place k = 0 … count − 1 of its arrays has number k of the half. The angle upstream of the
/// first one belongs to the other half.
struct half_ring {
  int apart, count, first, step;

  half_ring(const rotation_rows::ring& of, bool lower)
      : apart(of.apart), count(of.half()), first(lower ? of.half() : 0), step(lower ? of.apart : -of.apart) {}

  bool lower() const { return step > 0; }
  /// Returns the arrays of the half.
  double* at(double* places) const { return places + apart + (lower() ? count + 2 * apart : 0); }
  /// Returns the numbers of the edges downstream.
  const double* edges(const double* of) const { return of + first + (lower() ? apart : 0); }
  /// Calls body(lanes, k) for all places of the half and of the angle upstream.
  template <class Body>
  void with_upstream(const Body& body) const {
    const int begin = lower() ? -apart : 0;
    for_packs(count + apart, [=](auto lanes, int k) APSIS_PACKED { body(lanes, begin + k); });
  }
};

void find_rotation_fluxes(const half_ring& of, const rotation_rows::flux_rule& rule, const double* values,
                          const rotation_rows::places& to) {
  const double *from = values + rotation_rows::halo * of.apart + of.first, *speeds = of.edges(rule.speeds),
               *slopes = of.edges(rule.slopes);
  double *low_order = of.at(to.low_order), *fluxes = of.at(to.fluxes);
  const int step = of.step;
  const bool fifth_order = rule.fifth_order;
  const rotation_factors factors{rule.first, rule.third, rule.second};
  of.with_upstream([=](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const auto value = [=](int i) APSIS_PACKED { return N::load(from + k + i * step); };
    const auto out = fluxes_of_rotation(rotation_edge<N>{N::load(speeds + k), N::load(slopes + k)}, factors,
                                        fifth_order, value(-2), value(-1), value(0), value(1), value(2));
    out.low_order.store(low_order + k);
    out.high_order.store(fluxes + k);
  });
}

/// Returns true if a fraction is below 1.
bool find_fractions(const half_ring& of, const rotation_rows::flux_rule& rule, const double* values,
                    const rotation_rows::places& to) {
  const double *from = values + rotation_rows::halo * of.apart + of.first, *inverse = rule.inverse + of.first,
               *low_order = of.at(to.low_order), *fluxes = of.at(to.fluxes);
  double* fractions = of.at(to.fractions);
  const double scale = rule.scale;
  const int step = of.step;
  bool limits = false;
  for_packs(of.count, [=, &limits](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    const auto out_of = [=](int place) APSIS_PACKED {
      return rotation_fluxes<N>{N::load(low_order + place), N::load(fluxes + place)};
    };
    const N fraction =
        fraction_of_rotation(out_of(k - step), out_of(k), N::load(from + k), N(scale) * N::load(inverse + k));
    limits = limits || any<N>(fraction < N(1.0));
    fraction.store(fractions + k);
  });
  return limits;
}

void limit_rotation(const half_ring& of, const rotation_rows::places& to) {
  const double *low_order = of.at(to.low_order), *fluxes = of.at(to.fluxes), *fractions = of.at(to.fractions);
  double* limited = of.at(to.limited_fluxes);
  const int step = of.step;
  of.with_upstream([=](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    limited_edge(N::load(low_order + k), N::load(fluxes + k), N::load(fractions + k),
                 N::load(fractions + k + step))
        .store(limited + k);
  });
}

/// Copies the fractions at both ends of a half to the neighbouring places of the other half.
void join_fractions(const half_ring& of, const half_ring& to, double* fractions) {
  const double* from = of.at(fractions);
  std::copy_n(from, of.apart, to.at(fractions) + to.count);
  std::copy_n(from + of.count - of.apart, of.apart, to.at(fractions) - of.apart);
}

void turn(const rotation_rows::ring& ring, const rotation_rows::flux_rule& rule, const double* values,
          double rate, const rotation_rows::places& to, double* change) {
  const half_ring upper(ring, false), lower(ring, true);
  for (const half_ring& of : {upper, lower}) find_rotation_fluxes(of, rule, values, to);
  bool limits = false;
  for (const half_ring& of : {upper, lower})
    if (rule.limited) limits = find_fractions(of, rule, values, to) || limits;
  if (limits) {
    join_fractions(upper, lower, to.fractions);
    join_fractions(lower, upper, to.fractions);
    for (const half_ring& of : {upper, lower}) limit_rotation(of, to);
  }
  for (const half_ring& of : {upper, lower}) {
    const double* out = of.at(limits ? to.limited_fluxes : to.fluxes);
    double* into = change + of.first;
    const int step = of.step;
    for_packs(of.count, [=](auto lanes, int k) APSIS_PACKED {
      using N = pack<decltype(lanes)>;
      (N(rate) * (N::load(out + k - step) - N::load(out + k))).store(into + k);
    });
  }
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(turn);
}  // namespace

namespace rotation_rows {

std::size_t ring::continued() const {
  const int all = size() + 2 * halo * apart;
  return static_cast<std::size_t>(all);
}

std::size_t ring::places() const {
  const int all = size() + 4 * apart;
  return static_cast<std::size_t>(all);
}

void continue_ring(const ring& of, const double* row, double* values) {
  const int n = of.size(), beyond = halo * of.apart;
  std::copy_n(row + n - beyond, beyond, values);
  std::copy_n(row, n, values + beyond);
  std::copy_n(row, beyond, values + beyond + n);
}

void turn(const ring& of, const flux_rule& rule, const double* values, double rate, const places& to,
          double* change) {
  HWY_DYNAMIC_DISPATCH(turn)(of, rule, values, rate, to, change);
}

}  // namespace rotation_rows
}  // namespace apsis
#endif
