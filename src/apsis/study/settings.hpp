#pragma once

#include <apsis/config/case.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Settings "key=value" of studies in layers, and their numerical values.

/// Returns whether a key is a step key, space.cells or velocity.points.
bool is_resolution_key(const std::string& key);

/// Returns "key" of "key=value".
std::string key_of(const std::string& setting);

/// Returns two layers of settings as one. An upper setting replaces a lower one of the same key, and a step
/// rule replaces any step rule.
std::vector<std::string> layered(const std::vector<std::string>& lower,
                                 const std::vector<std::string>& upper);

/// Returns a text of everything that determines the numbers of a run. Cases with equal texts
/// have equal results.
std::string numerical_identity(case_config config);

/// Returns the numerical value of a key in a case; NaN if it is not a number (text, a formula
/// in x, an unset key).
double number_of(const case_config& config, const std::string& key);

/// Returns the refined length: Δx for space.cells, Δv for velocity.points; otherwise the value itself. Δx and
/// Δv are those along a direction. Δv is the mean distance between neighbours of the velocities of the run.
double resolution(const case_config& config, const std::string& key, std::size_t direction = 0);
/// Returns the name of the refined length: "Δx" for space.cells, "Δv" for velocity.points, "Δt" for step
/// keys; otherwise the key.
std::string resolution_name(const std::string& key);

}  // namespace apsis
