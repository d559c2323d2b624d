#include <apsis/scheme/formulas/upwind.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <cstddef>

namespace apsis {
namespace {

void copy_row(const double* row, int width, double* edge) {
  for (int k = 0; k < width; ++k) edge[k] = scalar::upwind1_edge(row[k]);
}

/// Both edges equal the value of the cell. Upwind fluxes of these edges are the first-order upwind scheme,
/// which is monotone and entropy-decaying up to CFL 1.
class upwind1 final : public reconstruction {
 public:
  int ghost_width() const override { return 1; }
  int order() const override { return 1; }
  void edges(const double* const* rows, int count, int width, double* left, double* right) const override {
    for (int i = 0; i < count; ++i) {
      copy_row(rows[i], width, left + static_cast<std::ptrdiff_t>(i) * width);
      copy_row(rows[i], width, right + static_cast<std::ptrdiff_t>(i) * width);
    }
  }
  void outflow_edges(const double* const* rows, int count, int width, const double*,
                     double* edge) const override {
    for (int i = 0; i < count; ++i) copy_row(rows[i], width, edge + static_cast<std::ptrdiff_t>(i) * width);
  }
};

}  // namespace

extern const reconstruction_entry reconstruction_upwind1;
const reconstruction_entry reconstruction_upwind1 = {
    .name = "upwind1",
    .description = "first-order upwind: monotone, positive and entropy-decaying up to CFL 1",
    .source = "Courant, Isaacson, Rees (1952)",
    .linear = true,
    .make = []() -> std::unique_ptr<reconstruction> { return std::make_unique<upwind1>(); }};

}  // namespace apsis
