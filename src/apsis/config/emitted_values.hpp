#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/space_time_formula.hpp>
#include <apsis/model/gas.hpp>
#include <apsis/model/model.hpp>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace apsis {

/// A surface of a case that may emit a gas: a side of the domain, a solid box or a body.
struct emitter {
  std::string path;              ///< its table: "boundary.left"
  std::string kind;              ///< kind of the boundary condition
  const state_formulas* given;   ///< values of its variables, owned by the configuration
  std::vector<position> points;  ///< points at which formulas are sampled
};

/// Returns the sides of the domain, the solid boxes and the bodies. The configuration must outlive them.
std::vector<emitter> emitters_of(const case_config& config);

/// The variables of the boundary condition of an emitter, given by formulas or defaults.
class emitted_values {
 public:
  /// Throws input_error if the model cannot have the boundary condition.
  emitted_values(const case_config& config, const model& equation, const emitter& of);

  /// Returns whether the condition has a variable of this name.
  bool has(const std::string& name) const { return all_.contains(name); }
  /// Returns whether f is given as a function of the velocity.
  bool by_functions() const { return has("f") || has("g"); }
  /// Returns whether the condition emits a gas of a given temperature or distribution.
  bool any() const { return by_functions() || has("T"); }
  /// Returns whether no value depends on t.
  bool steady() const;
  /// Returns component k of a variable; the default if it is not given.
  double at(const std::string& name, std::size_t k, double t, const position& x,
            const position& v = {}) const;
  /// Returns the emitted state, with ρ = 1 if the density is not given. For functions of the velocity, it
  /// follows from their moments at the velocities of the gas. The state may be inadmissible.
  fluid_state state(const gas& molecules, double t, const position& x) const;

 private:
  struct value {
    double standard;
    std::vector<space_time_formula> formulas;
  };
  std::map<std::string, value> all_;
};

}  // namespace apsis
