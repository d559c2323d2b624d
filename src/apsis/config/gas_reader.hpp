#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>
#include <apsis/model/model_registry.hpp>

#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// Returns the scales of the table [gas], whose keys `config` has; nothing without the table. Throws
/// input_error if the model is not a gas, or a key is missing. Also throws it unless exactly one of pressure,
/// density and number density is given.
std::optional<gas_scales> read_gas_scales(const case_text& text, const model_entry& model,
                                          const case_config& config);

/// Returns a warning for each number without a unit that is far from the reference state in `config`:
/// temperatures, velocities, densities and pressures of the initial data, faces, solid boxes, bodies and
/// [output.reference]. Returns nothing without scales. The text must still have its units.
std::vector<std::string> warnings_of_missing_units(const case_text& text, const model_entry& model,
                                                   const case_config& config);

/// Replaces quantities with units in the values of a case by dimensionless numbers; those of [parameters] may
/// have any dimension. Tables in time and profiles become formulas (table_reader.hpp, profile_reader.hpp).
/// Throws input_error at the place of a key for a unit without scales, or for one of another dimension than
/// the key. Also throws as read_tables_in_time() and read_profiles() do.
void remove_units(case_text& text, const model_entry& model, const std::optional<gas_scales>& scales);

/// Sets the options of the model that the scales in `config` determine: collision_rate,
/// viscosity_exponent, prandtl, degrees_of_freedom. Throws input_error if the case gives another value,
/// or the model cannot have it.
void set_gas_of_model(case_text& text, const model_entry& model, const case_config& config);

/// Sets model.epsilon from model.knudsen, model.rarefaction or the scales in `config`, to the converted
/// number or to the formula as given. Formulas may use the constants in `config`. Returns the formula with
/// its conversion; nothing for a number, or if epsilon itself is given. Throws input_error if more than one
/// of these keys is given, a value contradicts the scales, or the viscosity of the model is not ε T^s.
std::optional<epsilon_formula> derive_epsilon(case_text& text, const model_entry& model,
                                              const case_config& config);

}  // namespace apsis
