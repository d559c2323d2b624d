#pragma once

#include <apsis/boundary/boundary.hpp>
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/model/gas_model.hpp>

#include <span>
#include <string>
#include <vector>

namespace apsis {

/// Returns the gas of a model. Throws input_error with the name of the boundary that needs it if the model is
/// no gas.
const gas& gas_of(const model& equation, const std::string& boundary_name);

/// An open end of a gas whose incoming components are those of the Maxwellian of a state that follows from
/// the gas inside, such as a far field or a given pressure. Dimensionless.
class gas_end : public incoming_boundary {
 public:
  /// `equation` must outlive the object. Throws input_error with the name of the boundary if it is no gas.
  gas_end(const model& equation, std::string boundary_name);

  /// Throws numerical_error if no Maxwellian has the state outside.
  void incoming_given_outgoing(const face& where, double t, const position& at, const double* outgoing,
                               std::span<const double* const> ghosts, double* incoming) const final;

 protected:
  /// Returns the state of entering gas, given the state inside at the face, which is not admissible if there
  /// is no gas.
  virtual fluid_state outside(const fluid_state& inside, const face& where, double t,
                              const position& at) const = 0;

  /// Changes the incoming components, given the outgoing ones; changes nothing by default.
  virtual void adjust(const face& /*where*/, double /*t*/, const position& /*at*/, const double* /*outgoing*/,
                      double* /*incoming*/) const {}

  const gas& molecules() const { return molecules_; }  ///< the gas inside
  double gamma() const { return gamma_; }              ///< ratio of specific heats (D + 2)/D
  double sound(double T) const;                        ///< speed of sound √(γT)

 private:
  /// `row`: scratch of one row.
  fluid_state state_at_face(std::span<const double* const> ghosts, double* row) const;

  const gas& molecules_;
  std::string name_;
  double gamma_;
};

/// Component of u along the outward normal of a face.
inline double outward(const fluid_state& state, const face& where) {
  return where.upper ? state.u[where.direction] : -state.u[where.direction];
}
/// Replaces that component.
inline void set_outward(fluid_state& state, const face& where, double velocity) {
  state.u[where.direction] = where.upper ? velocity : -velocity;
}

}  // namespace apsis
