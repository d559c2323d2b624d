#include <apsis/space/reconstruction_registry.hpp>
#include <apsis/space/weno5.hpp>

namespace apsis {
namespace {

/// g_k = 1/(β_k + 1e-6)² (Jiang & Shu, JCP 126, 1996). The 1e-6 is theirs and has the unit of the data
/// squared.
class weno5_js final : public reconstruction {
 public:
  int ghost_width() const override { return 2; }
  int order() const override { return 5; }
  void edges(const double* const* rows, int count, int width, double* left, double* right) const override {
    weno5::sweep(rows, count, width, left, right, [](const weno5::smoothness& s) {
      constexpr double delta = 1e-6;
      const auto [y0, y1, y2, per_largest] = weno5::scale(s, delta);
      const double z0 = y0 * y0, z1 = y1 * y1, z2 = y2 * y2;
      return weno5::factors{z1 * z2, z0 * z2, z0 * z1};
    });
  }
};

}  // namespace

extern const reconstruction_entry reconstruction_weno5_js;
const reconstruction_entry reconstruction_weno5_js = {
    "weno5-js", "fifth order WENO with the weights of Jiang and Shu", "Jiang, Shu, JCP 126 (1996) 202-228",
    []() -> std::unique_ptr<reconstruction> { return std::make_unique<weno5_js>(); }};

}  // namespace apsis
