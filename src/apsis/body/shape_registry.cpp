#include <apsis/body/shape_registry.hpp>

#include <apsis/body/placed_shape.hpp>
#include <apsis/body/rotation.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace apsis {
namespace {

rotation rotation_of(const shape_arguments& from) {
  if (from.dimensions() == 2) return {{0.0, 0.0, 1.0}, from.number("rotate")};
  return {from.direction("rotate"), from.numbers("rotate").back()};
}

void check_dimensions(const shape_entry& entry, int dimensions) {
  if (dimensions != 2 && dimensions != 3)
    throw input_error(fmt::format("shape '{}' has {} dimensions (shapes have 2 or 3); use another mesh",
                                  entry.name, dimensions));
  if (std::find(entry.dimensions.begin(), entry.dimensions.end(), dimensions) != entry.dimensions.end())
    return;
  throw input_error(fmt::format("shape '{}' has no form in {} dimensions (it is a shape of {}); {}",
                                entry.name, dimensions, entry.dimensions.front(), entry.alternative));
}

}  // namespace

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const shape_entry* entry : shape_entries()) names.push_back(entry->name);
  return names;
}

const shape_entry& find_shape(const std::string& name) {
  for (const shape_entry* entry : shape_entries())
    if (entry->name == name) return *entry;
  throw input_error(fmt::format("unknown shape '{}' (there is no such kind); {}", name.substr(0, 60),
                                suggest(name, shape_names())));
}

std::vector<shape_key> common_shape_keys(int dimensions) {
  const auto components = static_cast<std::size_t>(dimensions);
  shape_key rotate = {.name = "rotate",
                      .doc = "angle in degrees, about the origin, before the shift",
                      .kind = shape_value_kind::number,
                      .value = 0.0,
                      .is_length = false};
  if (dimensions == 3)
    rotate = {.name = "rotate",
              .doc = "axis through the origin and angle in degrees, before the shift",
              .kind = shape_value_kind::vector,
              .value = std::vector<double>{0.0, 0.0, 1.0, 0.0},
              .components = 4,
              .is_length = false};
  return {{.name = "shift",
           .doc = "vector that is added to all points",
           .kind = shape_value_kind::vector,
           .value = std::vector<double>(components, 0.0),
           .components = components},
          rotate};
}

std::shared_ptr<const shape> make_shape(const std::string& name, const shape_values& values, int dimensions) {
  const shape_entry& entry = find_shape(name);
  check_dimensions(entry, dimensions);
  std::vector<shape_key> keys = entry.keys;
  for (shape_key& common : common_shape_keys(dimensions)) keys.push_back(std::move(common));
  const shape_arguments arguments = check_shape_values(name, keys, values, dimensions);
  const rotation turn = rotation_of(arguments);
  const position shift = arguments.vector("shift");
  std::shared_ptr<const shape> made = entry.make(arguments);
  if (turn.is_identity() && shift == position{}) return made;
  return std::make_shared<placed_shape>(std::move(made), turn, shift);
}

}  // namespace apsis
