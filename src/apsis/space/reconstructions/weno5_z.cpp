#include <apsis/space/reconstruction_registry.hpp>
#include <apsis/space/weno5.hpp>

#include <cmath>

namespace apsis {
namespace {

/// g_k = 1 + (τ/(β_k + δ))², τ = |β₀ − β₂| (Borges, Carmona, Costa & Don, JCP 227, 2008, with power 2, which
/// keeps fifth order at smooth extrema).
class weno5_z final : public reconstruction {
 public:
  int ghost_width() const override { return 2; }
  int order() const override { return 5; }
  void edges(const double* const* rows, int count, int width, double* left, double* right) const override {
    weno5::sweep(rows, count, width, left, right, [](const weno5::smoothness& s) {
      // Relative to the data, so that the scheme does not change with their scale: variations below a
      // thousandth of the local size count as smooth, also where the first two derivatives vanish together.
      const double delta = 1e-6 * s.mean_square + 1e-200;
      const auto [y0, y1, y2, per_largest] = weno5::scale(s, delta);
      const double tau = (s.s0 - s.s2) * per_largest;
      const double t = tau * tau, z0 = y0 * y0, z1 = y1 * y1, z2 = y2 * y2;
      return weno5::factors{z1 * z2 * (z0 + t), z0 * z2 * (z1 + t), z0 * z1 * (z2 + t)};
    });
  }
};

}  // namespace

extern const reconstruction_entry reconstruction_weno5_z;
const reconstruction_entry reconstruction_weno5_z = {
    "weno5-z", "fifth order WENO with Z weights: full order at smooth extrema",
    "Borges, Carmona, Costa, Don, JCP 227 (2008) 3191-3211",
    []() -> std::unique_ptr<reconstruction> { return std::make_unique<weno5_z>(); }};

}  // namespace apsis
