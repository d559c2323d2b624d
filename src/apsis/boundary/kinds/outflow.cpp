#include <apsis/boundary/boundary_registry.hpp>

namespace apsis {
namespace {

/// Zero gradient: every ghost row is the row of the cell at the face.
class outflow_boundary final : public repeating_boundary {
 public:
  std::optional<int> cell_of_ghost(int, int) const override { return 0; }
};

}  // namespace

extern const boundary_entry boundary_outflow;
const boundary_entry boundary_outflow = {
    .name = "outflow",
    .description = "zero gradient: ghost cells repeat the cell at the face, so that waves leave",
    .make = [](const boundary_source&) -> std::unique_ptr<boundary> {
      return std::make_unique<outflow_boundary>();
    }};

}  // namespace apsis
