#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/mirrored_components.hpp>

#include <algorithm>

namespace apsis {
namespace {

/// A plane of symmetry, or a wall that reflects particles specularly: ghost cells are the mirror images of
/// the cells inside, with the normal velocity reversed. Mass, energy and tangential momentum do not cross the
/// face.
class symmetry_boundary final : public boundary {
 public:
  /// Without velocities: a description that prepared() turns into a boundary of a face.
  symmetry_boundary() = default;
  explicit symmetry_boundary(std::vector<int> mirrored) : mirrored_(std::move(mirrored)) {}

  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    return std::make_shared<symmetry_boundary>(mirrored_components(velocities, where.direction));
  }

  void fill(const face&, double, const pencil_end& rows) const override {
    for (std::size_t g = 0; g < rows.ghosts.size(); ++g) {
      const double* image = rows.inside[std::min(g, rows.inside.size() - 1)];
      double* ghost = rows.ghosts[g];
      for (std::size_t k = 0; k < mirrored_.size(); ++k) ghost[k] = image[mirrored_[k]];
    }
  }

 private:
  std::vector<int> mirrored_;  ///< component whose normal velocity is opposite
};

}  // namespace

extern const boundary_entry boundary_symmetry;
const boundary_entry boundary_symmetry = {
    .name = "symmetry",
    .description =
        "plane of symmetry, or wall that reflects specularly: mirror images with reversed normal velocity",
    .make = [](const boundary_source&) -> std::unique_ptr<boundary> {
      return std::make_unique<symmetry_boundary>();
    }};

}  // namespace apsis
