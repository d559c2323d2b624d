#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/mirrored_components.hpp>
#include <apsis/boundary/oblique_reflection.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace apsis {
namespace {

/// A wall at rest with any normal that reflects specularly, without shear and heat flux.
class oblique_mirror final : public oblique_wall {
 public:
  explicit oblique_mirror(const velocity_set& velocities) : reflection_(velocities) {}

  void emit(const wall_point& where, const double* inward, const double* arriving,
            double* values) const override {
    reflection_.reflect(where.normal, inward, arriving, values);
  }

  std::array<double, 3> velocity(const wall_point&) const override { return {}; }

 private:
  oblique_reflection reflection_;
};

/// A plane of symmetry, or a wall that reflects particles specularly. Ghost cells are the mirror images
/// of the cells inside, with reversed normal velocity. Mass, energy and tangential momentum do not
/// cross the face. Some images are missing in a pencil with fewer cells than ghost rows, for example
/// between the plane and a body. The values that enter are then the mirror images of those that leave,
/// in the fluxes themselves.
class symmetry_boundary final : public boundary {
 public:
  /// Makes a description that prepared() turns into the boundary of a face. Without a model, all sets of
  /// components keep their signs.
  explicit symmetry_boundary(const model* equation) : equation_(equation) {}

  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    auto own = std::make_shared<symmetry_boundary>(nullptr);
    own->mirrored_ = mirrored_components(velocities, where.direction);
    own->signs_.assign(own->mirrored_.size(), 1.0);
    const auto of_sets =
        equation_ != nullptr ? equation_->reflection_signs(where.direction) : std::vector<double>{};
    for (std::size_t k = 0; k < own->signs_.size() && !of_sets.empty(); ++k)
      own->signs_[k] = of_sets[k / static_cast<std::size_t>(velocities.size())];
    return own;
  }

  /// Returns a wall only for a gas: other components may not be densities of particles.
  std::shared_ptr<const oblique_wall> oblique(const velocity_set& velocities) const override {
    if (equation_ == nullptr || equation_->as_gas() == nullptr) return nullptr;
    return std::make_shared<oblique_mirror>(velocities);
  }

  void fill(const face&, double, const pencil_end& rows) const override {
    for (std::size_t g = 0; g < rows.ghosts.size(); ++g) {
      const double* image = rows.inside[std::min(g, rows.inside.size() - 1)];
      double* ghost = rows.ghosts[g];
      for (std::size_t k = 0; k < mirrored_.size(); ++k) ghost[k] = signs_[k] * image[mirrored_[k]];
    }
  }

  bool prescribes_incoming(int cells, int ghosts) const override { return cells < ghosts; }

  void incoming(const face&, double, const position&, const double* outgoing, double* values) const override {
    for (std::size_t k = 0; k < mirrored_.size(); ++k) values[k] = signs_[k] * outgoing[mirrored_[k]];
  }

  /// Returns {}, because mirrored components have the same entropy; nothing if signs change.
  std::optional<std::vector<double>> entropy_bound() const override {
    if (std::any_of(signs_.begin(), signs_.end(), [](double sign) { return sign != 1.0; }))
      return std::nullopt;
    return std::vector<double>{};
  }

 private:
  const model* equation_;
  std::vector<int> mirrored_;  ///< for each component, the one with the opposite normal velocity
  std::vector<double> signs_;  ///< sign of every component
};

}  // namespace

extern const boundary_entry boundary_symmetry;
const boundary_entry boundary_symmetry = {
    .name = "symmetry",
    .description =
        "plane of symmetry, or wall that reflects specularly: mirror images with reversed normal velocity",
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      // A line has only one mirror. Errors that are thrown here have a position in the case.
      if (from.equation != nullptr && from.equation->space_dimensions() == 1)
        from.equation->reflection_signs(0);
      return std::make_unique<symmetry_boundary>(from.equation);
    },
    .any_normal = true};

}  // namespace apsis
