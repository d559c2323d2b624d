#pragma once

#include <apsis/boundary/boundary.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace apsis {

/// Applies a boundary condition to axisymmetric flow, with the unknowns F = r f. The axis is a condition of
/// its own. This object passes f to the condition: it divides outgoing values and the ghost rows that the
/// condition reads by r. It multiplies incoming values by r at the point of the face. A condition may
/// extrapolate a value at the face from ghost rows. This value is then that of F, divided by r.
///
/// Conditions that prescribe incoming values continue F in the same way as f. If a condition repeats a cell
/// beyond a face r = const, ghost rows are r f with the f of this cell. Other conditions, such as planes of
/// symmetry, are possible only at planes x = const, where r is constant along a pencil. Dimensionless.
class radial_boundary final : public boundary {
 public:
  /// `radial` is the direction of r, and `spacing` is Δr.
  radial_boundary(std::shared_ptr<const boundary> of, int radial, double spacing);

  /// Throws input_error if the condition is not possible at r = const, and as the condition does.
  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override;
  std::shared_ptr<const boundary> on_surface(const std::function<double()>& area) const override;
  std::shared_ptr<const oblique_wall> oblique(const velocity_set& velocities) const override;
  double multiple_of_cell(const face& where, const position& at, int cells) const override;
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
  /// Returns nothing: the sum of η(F) may increase, because F η′ is no function of f.
  std::optional<std::vector<double>> entropy_bound() const override { return std::nullopt; }
  const boundary& undecorated() const override { return of_->undecorated(); }

 private:
  double radius(const position& at) const { return at[static_cast<std::size_t>(radial_)]; }
  double ratio_of_radii(const face& where, const position& at, int ghost, int cell) const;

  std::shared_ptr<const boundary> of_;
  int radial_;
  double spacing_;
  int components_ = 0;    ///< components of a row, set by prepared()
  bool crosses_ = false;  ///< whether pencils lie along r
};

}  // namespace apsis
