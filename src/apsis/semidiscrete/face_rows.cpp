#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/semidiscrete/face_rows.cpp"
#include <hwy/foreach_target.h>

#include <apsis/semidiscrete/face_rows.hpp>

#include <apsis/semidiscrete/formulas/face.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void keep_leaving(const double* inward, int n, double* values) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    if_leaving(N::load(inward + k), N::load(values + k)).store(values + k);
  });
}

void take_entering(const double* inward, const double* entering, int n, double* values) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    if_entering(N::load(inward + k), N::load(entering + k), N::load(values + k)).store(values + k);
  });
}

void add_entering(const double* inward, const double* values, double beta, double spacing, int n,
                  double* acc) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    with_entering(N::load(acc + k), N(beta), N::load(inward + k), N(spacing), N::load(values + k))
        .store(acc + k);
  });
}

void multiply(const double* inward, int n, double* values) {
  for_packs(n, [&](auto lanes, int k) APSIS_PACKED {
    using N = pack<decltype(lanes)>;
    (N::load(inward + k) * N::load(values + k)).store(values + k);
  });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(keep_leaving);
HWY_EXPORT(take_entering);
HWY_EXPORT(add_entering);
HWY_EXPORT(multiply);
}  // namespace

namespace face_rows {

void keep_leaving(const double* inward, int n, double* values) {
  HWY_DYNAMIC_DISPATCH(keep_leaving)(inward, n, values);
}

void take_entering(const double* inward, const double* entering, int n, double* values) {
  HWY_DYNAMIC_DISPATCH(take_entering)(inward, entering, n, values);
}

void add_entering(const double* inward, const double* values, double beta, double spacing, int n,
                  double* acc) {
  HWY_DYNAMIC_DISPATCH(add_entering)(inward, values, beta, spacing, n, acc);
}

void multiply(const double* inward, int n, double* values) {
  HWY_DYNAMIC_DISPATCH(multiply)(inward, n, values);
}

}  // namespace face_rows
}  // namespace apsis
#endif
