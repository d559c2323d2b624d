#pragma once

#include <apsis/output/picture.hpp>

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <validation/quantity.hpp>

namespace apsis::validation {

/// A reference value and the value that was computed for it.
struct compared_value {
  const quantity_entry* quantity = nullptr;
  const reference_value* reference = nullptr;
  double value = 0.0, wall_s = 0.0;

  /// Returns value/reference − 1.
  double difference() const;
  /// Whether |difference| ≤ tolerance; false for NaN.
  bool holds() const;
};

/// Returns "name=value" for every parameter.
std::vector<std::string> settings_of(const quantity_values& values);

/// Computes the value that a reference is compared with. Throws the errors of compute_quantity().
compared_value compare_with_reference(const quantity_entry& quantity, const reference_value& reference,
                                      const std::function<bool(double)>& progress = {});

/// Returns a picture of the values of one quantity over its first parameter, with a curve for each set of the
/// other parameters. A second panel has the differences with their tolerances. The picture has no panels if
/// the first parameter has fewer than three values.
picture quantity_picture(const quantity_entry& quantity, const std::vector<compared_value>& values);

/// Returns name, description, source, values and pictures of one quantity.
nlohmann::ordered_json to_json(const quantity_entry& quantity, const std::vector<compared_value>& values);

}  // namespace apsis::validation
