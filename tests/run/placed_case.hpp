#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/args.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

/// A mapping of space onto itself that maps axes to axes: x'[axis[k]] = sign[k] x[k].
struct placement {
  std::array<std::size_t, 3> axis = {0, 1, 2};
  std::array<double, 3> sign = {1.0, 1.0, 1.0};

  /// Returns the image of cell (or velocity) i of n along axis k.
  std::size_t image(std::size_t k, std::size_t i, std::size_t n) const {
    return sign[k] > 0.0 ? i : n - 1 - i;
  }
};

/// A boundary with formulas in {X}, {Y}, {Z}, the coordinates before a mapping, in {VX}, {VY}, {VZ},
/// and in t.
struct placed_wall {
  std::string kind;
  std::vector<std::pair<std::string, std::string>> scalars;
  std::string vector_name;
  std::vector<std::string> components;
};

/// A case in a box around the origin whose coordinates can be mapped.
struct placed_case {
  std::string head;  ///< text that no mapping changes
  std::size_t dimensions;
  std::array<std::size_t, 3> cells;
  std::array<double, 3> half_length;
  placed_wall initial;
  std::vector<placed_wall> faces;              ///< walls by face numbers before the mapping
  std::array<std::array<double, 2>, 3> solid;  ///< extent of a solid box
  placed_wall solid_wall;

  /// Returns the text of the case after a mapping.
  std::string text(const placement& to) const {
    std::array<std::string, 3> numbers, domain, lower, upper;
    for (std::size_t k = 0; k < dimensions; ++k) {
      const std::size_t there = to.axis[k];
      numbers[there] = fmt::format("{}", cells[k]);
      domain[there] = fmt::format("[{}, {}]", -half_length[k], half_length[k]);
      const double a = to.sign[k] * solid[k][0], b = to.sign[k] * solid[k][1];
      lower[there] = fmt::format("{:.17g}", std::min(a, b));
      upper[there] = fmt::format("{:.17g}", std::max(a, b));
    }
    std::string all = head + "[initial]\n" + values(initial, to) +
                      fmt::format(
                          "[space]\nlimiter = \"positivity\"\ncells = {}\ndomain = {}\n"
                          "[[space.solid]]\nfrom = {}\nto = {}\n",
                          list(numbers), list(domain), list(lower), list(upper)) +
                      values(solid_wall, to);
    for (std::size_t face = 0; face < faces.size(); ++face) {
      const std::size_t k = face / 2, side = to.image(k, face % 2, 2);
      all += fmt::format("[boundary.{}]\n", names[2 * to.axis[k] + side]) + values(faces[face], to);
    }
    return all;
  }

  /// Returns the largest difference between a state and the image of another one. Both have `sets` sets of
  /// points^d components.
  double difference(const std::vector<double>& before, const std::vector<double>& after, const placement& to,
                    std::size_t points, std::size_t sets) const {
    const std::array<std::size_t, 3> n = mapped(cells, to);
    std::array<std::size_t, 3> velocities = {1, 1, 1};
    std::fill_n(velocities.begin(), dimensions, points);
    const std::size_t lattice = velocities[0] * velocities[1] * velocities[2], row = sets * lattice;
    double largest = 0.0;
    for (std::size_t c = 0; c < before.size(); ++c) {
      const std::size_t cell = image(c / row, cells, n, to),
                        point = image(c % lattice, velocities, velocities, to);
      const double there = after[cell * row + c % row / lattice * lattice + point];
      largest = std::max(largest, std::abs(there - before[c]));
    }
    return largest;
  }

 private:
  static constexpr std::array<const char*, 6> names = {"left", "right", "bottom", "top", "back", "front"};

  /// Returns a formula in the coordinates after the mapping.
  std::string formula(const std::string& of, const placement& to) const {
    fmt::dynamic_format_arg_store<fmt::format_context> words;
    const std::array<const char*, 3> x = {"X", "Y", "Z"}, v = {"VX", "VY", "VZ"};
    for (std::size_t k = 0; k < 3; ++k) {
      const char sign = to.sign[k] > 0.0 ? '+' : '-', letter = "xyz"[to.axis[k]];
      const bool exists = k < dimensions;
      words.push_back(fmt::arg(x[k], exists ? fmt::format("({}{})", sign, letter) : "0"));
      words.push_back(fmt::arg(v[k], exists ? fmt::format("({}v_{})", sign, letter) : "0"));
    }
    return fmt::vformat(of, words);
  }

  std::string values(const placed_wall& wall, const placement& to) const {
    std::string text = wall.kind.empty() ? "" : fmt::format("kind = \"{}\"\n", wall.kind);
    for (const auto& [name, value] : wall.scalars)
      text += fmt::format("{} = \"{}\"\n", name, formula(value, to));
    if (wall.vector_name.empty()) return text;
    std::array<std::string, 3> vector;
    for (std::size_t k = 0; k < dimensions; ++k)
      vector[to.axis[k]] =
          fmt::format("\"{}({})\"", to.sign[k] > 0.0 ? "" : "-", formula(wall.components[k], to));
    return text + fmt::format("{} = {}\n", wall.vector_name, list(vector));
  }

  std::string list(const std::array<std::string, 3>& of) const {
    return fmt::format("[{}]",
                       fmt::join(of.begin(), of.begin() + static_cast<std::ptrdiff_t>(dimensions), ", "));
  }

  std::array<std::size_t, 3> mapped(const std::array<std::size_t, 3>& counts, const placement& to) const {
    std::array<std::size_t, 3> all = {1, 1, 1};
    for (std::size_t k = 0; k < dimensions; ++k) all[to.axis[k]] = counts[k];
    return all;
  }

  /// Returns the number of a cell among `n`, or of a velocity, after the mapping.
  std::size_t image(std::size_t number, const std::array<std::size_t, 3>& n,
                    const std::array<std::size_t, 3>& there, const placement& to) const {
    std::array<std::size_t, 3> at = {0, 0, 0};
    for (std::size_t k = dimensions; k-- > 0;) {
      at[to.axis[k]] = to.image(k, number % n[k], n[k]);
      number /= n[k];
    }
    std::size_t result = 0;
    for (std::size_t k = 0; k < dimensions; ++k) result = result * there[k] + at[k];
    return result;
  }
};
