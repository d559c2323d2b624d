#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/reconstructions/weno5_z.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/weno5-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

/// g_k = 1 + (τ/(β_k + δ))², τ = |β₀ − β₂| (Borges, Carmona, Costa & Don, JCP 227, 2008, with power 2, which
/// preserves fifth order at smooth extrema).
struct weights_z {
  static constexpr double added = 0.0;
  static constexpr bool of_any_size = true;

  /// δ is relative to the data, so that the scheme is scale-invariant: variations below a thousandth of the
  /// value count as smooth, even where the first two derivatives vanish together.
  template <class N>
  static HWY_INLINE weno5::smoothness<N> smoothness(const weno5::window<weights_z, N>& u) {
    return scale(indicators(u), fma(1e-6 * u.here, u.here, N(1e-200)));
  }
  template <class N>
  static HWY_INLINE weno5::factors<N> factors(const weno5::smoothness<N>& y) {
    const N tau = y.s0 - y.s2, t = tau * tau;
    const N z0 = y.s0 * y.s0, z1 = y.s1 * y.s1, z2 = y.s2 * y.s2;
    const N m0 = z1 * z2, m1 = z0 * z2, m2 = z0 * z1, all = m2 * z2;
    return {fma(t, m0, all), fma(t, m1, all), fma(t, m2, all)};
  }
};

void edges_z(const double* const* rows, int count, int width, double* left, double* right) {
  weno5::sweep_edges<weights_z>(rows, count, width, left, right);
}

void outflow_z(const double* const* rows, int count, int width, const double* forward, double* edge) {
  weno5::sweep_outflow<weights_z>(rows, count, width, forward, edge);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <apsis/scheme/reconstruction_registry.hpp>

namespace apsis {
namespace {

HWY_EXPORT(edges_z);
HWY_EXPORT(outflow_z);

class weno5_z final : public reconstruction {
 public:
  int ghost_width() const override { return 2; }
  int order() const override { return 5; }
  void edges(const double* const* rows, int count, int width, double* left, double* right) const override {
    HWY_DYNAMIC_DISPATCH(edges_z)(rows, count, width, left, right);
  }
  void outflow_edges(const double* const* rows, int count, int width, const double* forward,
                     double* edge) const override {
    HWY_DYNAMIC_DISPATCH(outflow_z)(rows, count, width, forward, edge);
  }
  double operations(bool both_edges) const override {
    return HWY_NAMESPACE::weno5::operations<HWY_NAMESPACE::weights_z>(both_edges);
  }
};

}  // namespace

extern const reconstruction_entry reconstruction_weno5_z;
const reconstruction_entry reconstruction_weno5_z = {
    .name = "weno5-z",
    .description = "fifth-order WENO with Z weights: full order at smooth extrema",
    .source = "Borges, Carmona, Costa, Don, JCP 227 (2008) 3191-3211",
    .make = []() -> std::unique_ptr<reconstruction> { return std::make_unique<weno5_z>(); }};

}  // namespace apsis
#endif
