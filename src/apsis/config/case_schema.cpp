#include <apsis/config/case_schema.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace apsis {

const std::vector<std::string>& step_keys() {
  static const std::vector<std::string> keys = {"time.dt", "time.cfl", "time.safety"};
  return keys;
}

bool is_step_key(const std::string& key) {
  return std::find(step_keys().begin(), step_keys().end(), key) != step_keys().end();
}

bool applies(const case_key& key, const model_entry& model) {
  switch (key.scope) {
    case key_scope::always:
      return true;
    case key_scope::space:
      return has_space(model);
    case key_scope::velocity:
      return model.has_velocity_grid;
  }
  return false;
}

std::string type_text(key_type type) {
  switch (type) {
    case key_type::integer:
      return "an integer";
    case key_type::number:
      return "a number";
    case key_type::text:
      return "a text";
    case key_type::quantity:
      return "a number with a unit";
    case key_type::formula:
      return "a number or a formula in x, y, z";
    case key_type::text_list:
      return "a text or a list of texts";
    case key_type::formulas:
      return "a number or a formula in t, x, y, z, or a list of up to 3";
    case key_type::integers:
      return "an integer or a list of up to 3 integers";
    case key_type::intervals:
      return "a pair of numbers or a list of up to 3 pairs";
    case key_type::points:
      return "a list of points, lists of coordinates";
  }
  return "";
}

std::string range_text(const case_key& key) {
  const bool numeric = key.type == key_type::integer || key.type == key_type::number ||
                       key.type == key_type::formula || key.type == key_type::integers;
  if (!numeric) return "";
  const bool above = std::isfinite(key.lowest), below = std::isfinite(key.highest);
  if (above && below)
    return fmt::format("{} {} and at most {}", key.lowest_excluded ? "above" : "at least", key.lowest,
                       key.highest);
  if (above) return fmt::format("{} {}", key.lowest_excluded ? "above" : "at least", key.lowest);
  return below ? fmt::format("at most {}", key.highest) : "";
}

}  // namespace apsis
