#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <cstddef>

namespace apsis {
namespace {

/// Both edges equal the value of the cell. With upwind fluxes this is the first-order upwind scheme, which is
/// monotone and does not increase entropy up to CFL 1.
class planted_upwind final : public reconstruction {
 public:
  int ghost_width() const override { return 1; }
  int order() const override { return 1; }
  void edges(const double* const* rows, int count, int width, double* left, double* right) const override {
    for (int i = 0; i < count; ++i) {
      std::copy_n(rows[i], width, left + static_cast<std::ptrdiff_t>(i) * width);
      std::copy_n(rows[i], width, right + static_cast<std::ptrdiff_t>(i) * width);
    }
  }
};

}  // namespace

extern const reconstruction_entry reconstruction_planted_upwind;
const reconstruction_entry reconstruction_planted_upwind = {
    .name = "planted-upwind",
    .description = "first-order upwind: monotone, positive and entropy-decaying up to CFL 1",
    .source = "Courant, Isaacson, Rees (1952)",
    .make = []() -> std::unique_ptr<reconstruction> { return std::make_unique<planted_upwind>(); }};

}  // namespace apsis
