#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/mirrored_components.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace apsis {
namespace {

/// The axis r = 0 of axisymmetric flow with the unknowns F = r f. For a velocity fixed in space, f is smooth
/// along a line through the axis, while r changes its sign. Ghost rows are therefore −F of the cells inside
/// with reversed v_r and v_θ. Nothing crosses the axis: the values that enter are those that leave, with v_r
/// reversed. Mass, energy and the momentum along the axis thus do not change, to rounding. The entering and
/// the leaving values are close to 0.
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

  /// Finds the images of components. Throws input_error if a component has no image, or if there is no v_θ.
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
  std::vector<int> mirrored_;  ///< component with the opposite v_r
  std::vector<int> opposite_;  ///< component with opposite v_r and v_θ
};

}  // namespace

extern const boundary_entry boundary_axis;
const boundary_entry boundary_axis = {.name = "axis",
                                      .description = "axis r = 0 of axisymmetric flow, at the lower end of r",
                                      .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
                                        // An error that is thrown here has a position in the case.
                                        if (from.equation != nullptr)
                                          axis_boundary().set_images(from.equation->space_dimensions() - 1,
                                                                     from.equation->velocities());
                                        return std::make_unique<axis_boundary>();
                                      }};

}  // namespace apsis
