#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/mirrored_components.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace apsis {
namespace {

/// The axis r = 0 of axisymmetric flow, whose unknowns are F = r f. Along a line through the axis f is smooth
/// for a velocity fixed in space, while r changes its sign: ghost rows are −F of the cells inside with v_r
/// and v_θ reversed. Nothing crosses the axis. The values that enter are those that leave with v_r reversed,
/// so that mass, energy and the momentum along the axis do not change, to rounding. Both are close to 0.
class axis_boundary final : public boundary {
 public:
  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    if (where.upper)
      throw input_error(
          "boundary 'axis' at the upper end of a direction (the axis lies at r = 0, the lower end); choose "
          "another kind, see: apsis list boundaries");
    auto own = std::make_shared<axis_boundary>();
    own->set_images(where.direction, velocities);
    return own;
  }

  bool is_axis() const override { return true; }
  bool prescribes_incoming(int, int) const override { return true; }

  void fill(const face&, double, const pencil_end& rows) const override {
    for (std::size_t g = 0; g < rows.ghosts.size(); ++g) {
      const double* image = rows.inside[std::min(g, rows.inside.size() - 1)];
      double* ghost = rows.ghosts[g];
      for (std::size_t k = 0; k < opposite_.size(); ++k) ghost[k] = -image[opposite_[k]];
    }
  }

  void incoming(const face&, double, const position&, const double* outgoing, double* values) const override {
    for (std::size_t k = 0; k < mirrored_.size(); ++k) values[k] = outgoing[mirrored_[k]];
  }

  /// Finds the images of components. Throws input_error if some have no image, or there is no v_θ.
  void set_images(int radial, const velocity_set& velocities) {
    if (velocities.dimensions() < radial + 2)
      throw input_error(
          "boundary 'axis' cannot be used (the velocities have no v_theta after v_r); choose polar "
          "velocities, "
          "or another boundary");
    mirrored_ = mirrored_components(velocities, radial);
    const std::vector<int> across = mirrored_components(velocities, radial + 1);
    for (const int k : mirrored_) opposite_.push_back(across[static_cast<std::size_t>(k)]);
  }

 private:
  std::vector<int> mirrored_;  ///< component whose v_r is opposite
  std::vector<int> opposite_;  ///< component whose v_r and v_θ are opposite
};

}  // namespace

extern const boundary_entry boundary_axis;
const boundary_entry boundary_axis = {.name = "axis",
                                      .description = "axis r = 0 of axisymmetric flow, at the lower end of r",
                                      .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
                                        // Errors have a place here.
                                        if (from.equation != nullptr)
                                          axis_boundary().set_images(from.equation->space_dimensions() - 1,
                                                                     from.equation->velocities());
                                        return std::make_unique<axis_boundary>();
                                      }};

}  // namespace apsis
