#include <apsis/scheme/formulas/upwind.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <cstddef>

namespace apsis {
namespace {

using scalar::upwind5_edge;

/// The linear scheme that WENO approaches on smooth data, without protection against oscillations. Sums of
/// its fluxes over a line are those of the values: Σ û_{i+1/2} = Σ u_i and Σ x_{i+1/2} û_{i+1/2} = Σ x_i u_i
/// for data that vanish at the ends, since each û reproduces linear functions.
class upwind5 final : public reconstruction {
 public:
  int ghost_width() const override { return 2; }
  int order() const override { return 5; }
  void edges(const double* const* rows, int count, int width, double* left, double* right) const override {
    for (int i = 0; i < count; ++i) {
      const double *a = rows[i - 2], *b = rows[i - 1], *c = rows[i], *d = rows[i + 1], *e = rows[i + 2];
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * width;
#pragma omp simd
      for (int k = 0; k < width; ++k) {
        left[at + k] = upwind5_edge(e[k], d[k], c[k], b[k], a[k]);
        right[at + k] = upwind5_edge(a[k], b[k], c[k], d[k], e[k]);
      }
    }
  }
  void outflow_edges(const double* const* rows, int count, int width, const double* forward,
                     double* edge) const override {
    for (int i = 0; i < count; ++i) {
      const double *a = rows[i - 2], *b = rows[i - 1], *c = rows[i], *d = rows[i + 1], *e = rows[i + 2];
      const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) * width;
#pragma omp simd
      for (int k = 0; k < width; ++k)
        edge[at + k] = forward[k] != 0.0 ? upwind5_edge(a[k], b[k], c[k], d[k], e[k])
                                         : upwind5_edge(e[k], d[k], c[k], b[k], a[k]);
    }
  }
};

}  // namespace

extern const reconstruction_entry reconstruction_upwind5;
const reconstruction_entry reconstruction_upwind5 = {
    .name = "upwind5",
    .description = "fifth-order linear upwind: for smooth solutions, without protection against oscillations",
    .source = "the linear weights of Jiang, Shu, JCP 126 (1996)",
    .make = []() -> std::unique_ptr<reconstruction> { return std::make_unique<upwind5>(); }};

}  // namespace apsis
