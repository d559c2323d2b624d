#pragma once

#include <apsis/boundary/boundary.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace apsis {

/// Any boundary condition but the axis in axisymmetric flow, where the unknowns are F = r f. The condition
/// sees f. Outgoing values are divided by r, and so are ghost rows that the condition reads. Incoming values
/// are multiplied by r at the point of the face. A value at the face that a condition extrapolates from ghost
/// rows is then that of F divided by r.
///
/// Conditions that prescribe incoming values continue F as they continue f. Where a condition repeats the
/// cell at a face r = const, ghost rows are F of the f there. Other conditions, such as planes of symmetry,
/// fill ghost rows at planes x = const only, where r is constant along a pencil. Dimensionless.
class radial_boundary final : public boundary {
 public:
  /// `radial`: the direction of r; `spacing`: Δr.
  radial_boundary(std::shared_ptr<const boundary> of, int radial, double spacing);

  /// Throws input_error where the condition is not possible at r = const, and as the condition does.
  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override;
  std::shared_ptr<const boundary> on_surface(const std::function<double()>& area) const override;
  std::shared_ptr<const oblique_wall> oblique(const velocity_set& velocities) const override;
  std::optional<int> cell_of_ghost(int ghost, int cells) const override;
  void fill(const face& where, double t, const pencil_end& rows) const override;
  bool prescribes_incoming(int cells, int ghosts) const override {
    return of_->prescribes_incoming(cells, ghosts);
  }
  void incoming(const face& where, double t, const position& at, const double* outgoing,
                double* incoming) const override;
  void incoming_given_outgoing(const face& where, double t, const position& at, const double* outgoing,
                               std::span<const double* const> ghosts, double* incoming) const override;
  std::array<double, 3> wall_velocity(double t, const position& at) const override {
    return of_->wall_velocity(t, at);
  }
  bool periodic() const override { return of_->periodic(); }
  /// Returns nothing: the sum of η(F) may increase, since F η′ is no function of f.
  std::optional<std::vector<double>> entropy_bound() const override { return std::nullopt; }
  const boundary& undecorated() const override { return of_->undecorated(); }

 private:
  double radius(const position& at) const { return at[static_cast<std::size_t>(radial_)]; }

  std::shared_ptr<const boundary> of_;
  int radial_;
  double spacing_;
  int components_ = 0;    ///< of a row, after prepared()
  bool crosses_ = false;  ///< whether pencils lie along r
};

}  // namespace apsis
