#include <apsis/boundary/boundary_registry.hpp>

#include <algorithm>

namespace apsis {
namespace {

/// Every component that moves inwards enters with the constant value 0.25. The others leave.
class planted_wall final : public boundary {
 public:
  void fill(const face& where, double, const pencil_end& rows) const override {
    const auto speeds = rows.velocities.speeds(where.direction);
    for (double* ghost : rows.ghosts)
      for (int k = 0; k < rows.components; ++k) {
        const double v = speeds[static_cast<std::size_t>(k)];
        ghost[k] = (where.upper ? v < 0.0 : v > 0.0) ? 0.25 : rows.inside[0][k];
      }
  }
};

}  // namespace

extern const boundary_entry boundary_planted_wall;
const boundary_entry boundary_planted_wall = {
    .name = "planted-wall",
    .description = "inflow of a constant",
    .make = [](const boundary_source&) -> std::unique_ptr<boundary> {
      return std::make_unique<planted_wall>();
    }};

}  // namespace apsis
