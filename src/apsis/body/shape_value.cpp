#include <apsis/body/shape_value.hpp>

#include <apsis/body/internal/vectors.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

// Squares and fourth powers of numbers within these limits are finite and positive.
constexpr double largest_number = 1e100, smallest_size = 1e-100;

/// Returns the name of a kind for messages, with its article.
const char* kind_name(shape_value_kind kind) {
  static constexpr std::array names = {"a number", "a list of numbers", "a list of points",
                                       "a text",   "a formula",         "a list of shapes"};
  return names.at(static_cast<std::size_t>(kind));
}

/// Checks the value of one key.
class value_check {
 public:
  value_check(const shape_arguments& all, const shape_key& key) : all_(all), key_(key) {}

  void check(const shape_value& value) const {
    const auto kind = static_cast<shape_value_kind>(value.index());
    if (kind != key_.kind)
      refuse(fmt::format("is {} ({} is needed)", kind_name(kind), kind_name(key_.kind)),
             fmt::format("give {}", kind_name(key_.kind)));
    std::visit([this](const auto& one) { check_one(one); }, value);
  }

 private:
  [[noreturn]] void refuse(const std::string& problem, const std::string& suggestion) const {
    all_.refuse(key_.name, problem, suggestion);
  }

  void check_one(double value) const {
    if (!std::isfinite(value)) refuse(fmt::format("is {} (it is not finite)", value), "give a finite number");
    if (std::abs(value) > largest_number)
      refuse(fmt::format("is {} (magnitudes are at most {})", value, largest_number), "use other units");
    if (key_.positive && !(value > 0.0))
      refuse(fmt::format("is {} (it must be positive)", value), "give a number > 0");
    if (key_.positive && value < smallest_size)
      refuse(fmt::format("is {} (sizes are at least {})", value, smallest_size), "use other units");
  }

  void check_one(const std::vector<double>& value) const {
    const std::size_t size =
        key_.components != 0 ? key_.components : static_cast<std::size_t>(all_.dimensions());
    if (value.size() != size)
      refuse(fmt::format("has {} components (it needs {})", value.size(), size),
             fmt::format("give {}", size));
    for (const double component : value) check_one(component);
  }

  void check_one(const std::vector<std::vector<double>>& value) const {
    check_count(value.size(), "points");
    for (const auto& point : value) check_one(point);
  }

  void check_one(const std::string& value) const {
    if (value.empty()) refuse("is empty (it is a text)", "give " + key_.doc);
  }

  void check_one(const level_set_function& value) const {
    if (!value) refuse("is empty (it is a formula)", "give a formula");
  }

  void check_one(const shape_list& value) const {
    check_count(value.size(), "shapes");
    for (const auto& one : value)
      if (one == nullptr) refuse("has an empty shape (it is null)", "make all shapes");
  }

  void check_count(std::size_t count, const char* items) const {
    if (count < key_.fewest)
      refuse(fmt::format("has {} {} (it needs at least {})", count, items, key_.fewest), "add some");
    if (key_.most != 0 && count > key_.most)
      refuse(fmt::format("has {} {} (it takes at most {})", count, items, key_.most), "combine them first");
  }

  const shape_arguments& all_;
  const shape_key& key_;
};

position filled_position(const std::vector<double>& components) {
  position filled = {};
  std::copy_n(components.begin(), std::min<std::size_t>(components.size(), 3), filled.begin());
  return filled;
}

}  // namespace

double shape_arguments::number(const std::string& key) const {
  return std::get<double>(values_.at(key));
}

const std::vector<double>& shape_arguments::numbers(const std::string& key) const {
  return std::get<std::vector<double>>(values_.at(key));
}

position shape_arguments::vector(const std::string& key) const {
  return filled_position(numbers(key));
}

position shape_arguments::direction(const std::string& key) const {
  const position given = vector(key);
  const double length = vectors::length(given);
  if (!(length > 0.0)) refuse(key, "is 0 (it has no direction)", "give a vector of another length");
  return {given[0] / length, given[1] / length, given[2] / length};
}

std::vector<position> shape_arguments::points(const std::string& key) const {
  std::vector<position> filled;
  for (const auto& point : std::get<std::vector<std::vector<double>>>(values_.at(key)))
    filled.push_back(filled_position(point));
  return filled;
}

const std::string& shape_arguments::text(const std::string& key) const {
  return std::get<std::string>(values_.at(key));
}

const level_set_function& shape_arguments::formula(const std::string& key) const {
  return std::get<level_set_function>(values_.at(key));
}

const shape_list& shape_arguments::shapes(const std::string& key) const {
  return std::get<shape_list>(values_.at(key));
}

void shape_arguments::refuse(const std::string& key, const std::string& problem,
                             const std::string& suggestion) const {
  throw input_error(fmt::format("'{}' of shape '{}' {}; {}", key, name_, problem, suggestion));
}

shape_arguments check_shape_values(const std::string& name, const std::vector<shape_key>& keys,
                                   const shape_values& given, int dimensions) {
  std::vector<std::string> names;
  for (const shape_key& key : keys) names.push_back(key.name);
  for (const auto& [key, value] : given)
    if (std::find(names.begin(), names.end(), key) == names.end())
      throw input_error(fmt::format("shape '{}' has no key '{}' (it is not one of its keys); {}", name,
                                    key.substr(0, 60), suggest(key, names)));
  shape_values all;
  for (const shape_key& key : keys) {
    const auto found = given.find(key.name);
    if (found == given.end() && !key.value)
      throw input_error(
          fmt::format("shape '{}' has no '{}' (it is the {}); add it", name, key.name, key.doc));
    all.emplace(key.name, found != given.end() ? found->second : *key.value);
  }
  shape_arguments arguments(name, std::move(all), dimensions);
  for (const shape_key& key : keys)
    if (const auto found = given.find(key.name); found != given.end())
      value_check(arguments, key).check(found->second);
  return arguments;
}

}  // namespace apsis
