#include <apsis/boundary/boundary_registry.hpp>

namespace apsis {
namespace {

/// The domain continues at its opposite face, several times if the stencil is wider than the mesh.
class periodic_boundary final : public repeating_boundary {
 public:
  std::optional<int> cell_of_ghost(int ghost, int cells) const override { return cells - 1 - ghost % cells; }
  bool periodic() const override { return true; }
};

}  // namespace

extern const boundary_entry boundary_periodic;
const boundary_entry boundary_periodic = {.name = "periodic",
                                          .description = "the opposite face continues the domain",
                                          .make = [](const boundary_source&) -> std::unique_ptr<boundary> {
                                            return std::make_unique<periodic_boundary>();
                                          }};

}  // namespace apsis
