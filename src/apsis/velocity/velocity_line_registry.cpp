#include <apsis/velocity/velocity_line_registry.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/core/text_file.hpp>
#include <apsis/velocity/velocity_grid.hpp>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Removes the first number from a text and stores it in `value`. Returns false if the text does not start
/// with a number.
bool take_number(std::string_view& text, double& value) {
  const auto first = text.find_first_not_of(" \t,;");
  if (first == std::string_view::npos) return false;
  const auto [end, error] = std::from_chars(text.data() + first, text.data() + text.size(), value);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

/// Returns the item of direction k from a list with one item for all directions, or one for each direction.
template <class Item>
const Item& item_of(const std::vector<Item>& list, std::size_t k, int dimensions, const char* key) {
  if (list.size() != 1 && list.size() != static_cast<std::size_t>(dimensions))
    throw input_error(fmt::format("{} has {} entries (the model has {} velocity dimension{}); give 1{}", key,
                                  list.size(), dimensions, dimensions == 1 ? "" : "s",
                                  dimensions == 1
                                      ? fmt::format(", or set model.velocity_dimensions = {}", list.size())
                                      : fmt::format(" or {}", dimensions)));
  return list.size() == 1 ? list.front() : list[k];
}

velocity_line make_line(const velocity_config& of, const std::string& name, int points) {
  if (is_velocity_file(name)) {
    velocity_line line = read_velocity_line(name);
    if (points != 0 && points != line.points())
      throw input_error(fmt::format("velocity.points = {} contradicts '{}' (it has {}); leave it out", points,
                                    name, line.points()));
    return line;
  }
  const velocity_line_entry& entry = find_velocity_line(name);
  if (points == 0)
    throw input_error(fmt::format(
        "velocity.points is missing (set '{}' needs it); add it, for example: points = 32", name));
  if (entry.needs_max && of.max == 0.0)
    throw input_error(
        fmt::format("velocity.max is missing (set '{}' needs it); add it, for example: max = 8.0", name));
  return entry.make(points, of.max);
}

}  // namespace

const velocity_line_entry* try_find_velocity_line(const std::string& name) {
  for (const velocity_line_entry* entry : velocity_line_entries())
    if (entry->name == name) return entry;
  return nullptr;
}

const velocity_line_entry& find_velocity_line(const std::string& name) {
  if (const velocity_line_entry* found = try_find_velocity_line(name)) return *found;
  std::vector<std::string> names;
  for (const auto* entry : velocity_line_entries()) names.push_back(entry->name);
  throw input_error(
      fmt::format("velocity.set = '{}' is not known (it is neither a kind of velocities nor a file "
                  "NAME.csv or NAME.txt); {}",
                  name.substr(0, 60), suggest(name, names)));
}

bool is_velocity_file(const std::string& name) {
  return name.ends_with(".csv") || name.ends_with(".txt");
}

velocity_line read_velocity_line(const std::string& path) {
  constexpr std::size_t longest = 10'000'000;
  const std::string text = read_text_file(path, longest, "file of velocities");
  if (text.size() > longest)
    throw input_error({path, 0, 0},
                      fmt::format("the file has more than {} bytes (velocities of one direction are "
                                  "few); give another",
                                  longest));
  std::vector<double> points, weights;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::string_view rest = line;
    if (rest.ends_with('\r')) rest.remove_suffix(1);
    if (rest.find_first_not_of(" \t") == std::string_view::npos || rest.starts_with('#')) continue;
    double v = 0.0, w = 0.0;
    const bool good = take_number(rest, v) && take_number(rest, w) &&
                      rest.find_first_not_of(" \t") == std::string_view::npos;
    if (!good && points.empty() && number == 1) continue;  // names of the columns
    if (!good)
      throw input_error({path, number, 0},
                        "not a velocity and its weight (two numbers are needed); write for "
                        "example 0.5, 0.1");
    points.push_back(v);
    weights.push_back(w);
  }
  try {
    return {std::move(points), std::move(weights)};
  } catch (const input_error& problem) {
    throw input_error({path, 0, 0}, problem.what());
  }
}

std::vector<velocity_line> make_lines(const velocity_config& of, int dimensions) {
  if (dimensions < 1 || dimensions > 3)
    throw input_error(fmt::format("{} velocity dimensions (not 1, 2 or 3); give 1, 2 or 3", dimensions));
  if (!of.lines.empty()) {
    std::vector<int> points;
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k)
      points.push_back(item_of(of.lines, k, dimensions, "the list of velocities").points());
    velocity_grid::check_size(points);
    return of.lines.size() == 1 ? std::vector(static_cast<std::size_t>(dimensions), of.lines.front())
                                : of.lines;
  }
  static const std::vector<std::string> uniform = {"uniform"};
  const auto& names = of.set.empty() ? uniform : of.set;
  std::vector<int> points;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k)
    points.push_back(item_of(of.points.each(), k, dimensions, "velocity.points"));
  velocity_grid::check_size(points);  // before the lines are made
  std::vector<velocity_line> lines;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k)
    lines.push_back(make_line(of, item_of(names, k, dimensions, "velocity.set"), points[k]));
  return lines;
}

}  // namespace apsis
