#pragma once

#include <apsis/boundary/boundary.hpp>
#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/model/gas_model.hpp>

#include <span>
#include <string>
#include <vector>

namespace apsis {

/// Returns the gas of a model. Throws input_error with the name of the boundary if the model is no gas.
const gas& gas_of(const model& equation, const std::string& boundary_name);

/// An open end of a gas with incoming components of a Maxwellian. The state of this Maxwellian follows from
/// the gas inside, as for a far field or a given pressure. Dimensionless.
class gas_end : public incoming_boundary {
 public:
  /// Takes a model, which must outlive the object, and the name of the kind. Throws input_error with this
  /// name if the model is no gas.
  gas_end(const model& equation, std::string boundary_name);

  /// Throws numerical_error if no Maxwellian has the state outside. If such gas leaves faster than sound,
  /// nothing enters instead.
  void incoming_given_outgoing(const face& where, double t, const position& at, const double* outgoing,
                               std::span<const double* const> ghosts, double* incoming) const final;

 protected:
  /// Returns the state of the entering gas. `inside` is the state inside at the face, which is not admissible
  /// if there is no gas.
  virtual fluid_state outside(const fluid_state& inside, const face& where, double t,
                              const position& at) const = 0;

  /// Changes the incoming components, given the outgoing ones. The default changes nothing.
  virtual void adjust(const face& /*where*/, double /*t*/, const position& /*at*/, const double* /*outgoing*/,
                      double* /*incoming*/) const {}

  const gas& molecules() const { return molecules_; }  ///< the gas inside
  double gamma() const { return gamma_; }              ///< ratio of specific heats (D + 2)/D
  double sound(double T) const;                        ///< speed of sound √(γT)

 private:
  /// `row` is scratch memory for one row.
  fluid_state state_at_face(std::span<const double* const> ghosts, double* row) const;

  const gas& molecules_;
  std::string name_;
  double gamma_;
};

/// Returns the component of u along the outward normal of a face.
inline double outward(const fluid_state& state, const face& where) {
  return where.upper ? state.u[where.direction] : -state.u[where.direction];
}
/// Replaces the component of u along the outward normal of a face.
inline void set_outward(fluid_state& state, const face& where, double velocity) {
  state.u[where.direction] = where.upper ? velocity : -velocity;
}

}  // namespace apsis
