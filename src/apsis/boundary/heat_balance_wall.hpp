#pragma once

#include <apsis/boundary/boundary.hpp>
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/boundary/prescribed_state.hpp>
#include <apsis/boundary/wall_temperature.hpp>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// A diffuse wall with a temperature T_w that follows from the heat that crosses the wall, at every face,
/// piece of wall and stage:
///   α (E − m e(T_w)) = q(T_w),  e(T) = Σ_in w v_n ½|v − u_w|² M / Σ_in w v_n M,  M = M[1, u_w, T].
/// The mass m = Σ_out w |v_n| f and the heat E = Σ_out w |v_n| ½|v − u_w|² f arrive. α is the accommodation,
/// and q is the heat that the wall gives away. The wall emits like a diffuse wall of temperature T_w. The
/// discrete sums are those of the fluxes in the step. To rounding, no mass crosses the wall, and no heat
/// other than q. e(T) and q(T) increase with T. Dimensionless.
class heat_balance_wall : public incoming_boundary, public wall_temperature {
 public:
  /// Takes a model, which must outlive the object, and the name of the kind. Throws input_error with this
  /// name if the model has no Maxwellians.
  heat_balance_wall(const model& equation, const std::string& kind, std::vector<face_quantity> velocity,
                    face_quantity accommodation);

  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const final;
  /// Returns the wall with any normal. Specular reflection may be unable to match the arriving energy, for
  /// example if only a few values of f are nonzero. The wall then re-emits all molecules that arrive.
  std::shared_ptr<const oblique_wall> oblique(const velocity_set& velocities) const final;
  std::array<double, 3> wall_velocity(double t, const position& at) const final;
  bool follows_from_gas() const final { return true; }
  /// Returns T_w; nothing if no molecule is re-emitted. Throws as incoming() does.
  std::optional<double> temperature(const wall_point& where, const velocity_set& velocities,
                                    const arriving_gas& arriving) const final;
  /// Throws numerical_error if no temperature that the velocities represent balances the heat.
  void incoming(const face& where, double t, const position& at, const double* outgoing,
                double* incoming) const final;

  /// Returns the variables `velocity` and `accommodation` of a kind. Throws input_error as
  /// the constructor does.
  static std::vector<data_variable> variables(const model& equation, const std::string& kind);

 protected:
  /// The heat c (T⁴ − T_0⁴) that a wall gives away.
  struct radiation {
    double factor = 0.0;        ///< c ≥ 0
    double surroundings = 0.0;  ///< T_0 ≥ 0
  };
  /// Returns the radiation of the wall.
  virtual radiation radiated(double t, const position& at) const = 0;
  /// Returns a copy of this object.
  virtual std::shared_ptr<heat_balance_wall> copy() const = 0;

 private:
  class balance;
  class oblique_form;

  std::string kind_;
  prescribed_state emitted_;
  std::vector<face_quantity> velocity_;
  face_quantity accommodation_;
  double heat_of_mass_;  ///< e(T)/T of continuous velocities, (D + 1)/2
  velocity_set velocities_;
  std::vector<int> mirrored_;      ///< for each component, the one with the opposite normal velocity
  std::vector<double> mass_flux_;  ///< fluxes of unit components of the first set; > 0 enters
};

}  // namespace apsis
