#pragma once

#include <apsis/config/case.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Keys of a case as studies handle them: settings "key=value" in layers, and the numbers behind them.

/// Whether a key is a step key, space.cells or velocity.points.
bool is_resolution_key(const std::string& key);

/// "key" of "key=value".
std::string key_of(const std::string& setting);

/// Settings over settings: an upper one takes the place of a lower one, a step rule that of any step rule.
std::vector<std::string> layered(const std::vector<std::string>& lower,
                                 const std::vector<std::string>& upper);

/// A text of all that decides the numbers of a run: two cases with the same one compute the same.
std::string numerical_identity(case_config config);

/// The number that a key has in a case; NaN where it is none (text, a formula in x, a key that is not set).
double number_of(const case_config& config, const std::string& key);

/// What a resolution key refines: Δx of space.cells, Δv of velocity.points; else the number itself.
double resolution(const case_config& config, const std::string& key);
/// What a key refines, by name: "Δx" of space.cells, "Δv" of velocity.points, "Δt" of step keys; else the
/// key.
std::string resolution_name(const std::string& key);

}  // namespace apsis
