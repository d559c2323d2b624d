#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/model/vector_math.cpp"
#include <hwy/foreach_target.h>

#include <apsis/model/vector_math.hpp>

#include <apsis/exec/simd-inl.hpp>

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void exp_of(double* x, int n) {
  const wide lanes;
  for (int j = 0; j < n; j += static_cast<int>(hn::Lanes(lanes)))
    hn::Store(hn::Exp(lanes, hn::Load(lanes, x + j)), lanes, x + j);
}

void log_of(double* x, int n) {
  const wide lanes;
  for (int j = 0; j < n; j += static_cast<int>(hn::Lanes(lanes)))
    hn::Store(hn::Log(lanes, hn::Load(lanes, x + j)), lanes, x + j);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {
namespace {
HWY_EXPORT(exp_of);
HWY_EXPORT(log_of);
}  // namespace

void exp_packets(double* x, int n) {
  HWY_DYNAMIC_DISPATCH(exp_of)(x, n);
}

void log_packets(double* x, int n) {
  HWY_DYNAMIC_DISPATCH(log_of)(x, n);
}

}  // namespace apsis
#endif
