#include <apsis/run/surface_table.hpp>

#include <algorithm>
#include <array>
#include <sstream>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Reads the components of a vector from the columns; 0 for a missing one.
class vector_reader {
 public:
  vector_reader(const std::vector<std::string>& columns, const std::string& name) {
    for (std::size_t k = 0; k < 3; ++k)
      places_[k] =
          std::find(columns.begin(), columns.end(), fmt::format("{}_{}", name, "xyz"[k])) - columns.begin();
    missing_ = static_cast<std::ptrdiff_t>(columns.size());
  }

  bool is_there() const { return places_[0] != missing_; }
  std::array<double, 3> of(const std::vector<double>& row) const {
    std::array<double, 3> x{};
    for (std::size_t k = 0; k < 3; ++k)
      if (places_[k] != missing_) x[k] = row[static_cast<std::size_t>(places_[k])];
    return x;
  }

 private:
  std::array<std::ptrdiff_t, 3> places_{};
  std::ptrdiff_t missing_ = 0;
};

}  // namespace

polydata to_polydata(const surface_table& surface) {
  const auto& [columns, rows] = surface.numbers;
  polydata made{surface.corners, {}};
  for (std::size_t column = 0; column < columns.size(); ++column) {
    auto& values = made.data.emplace_back(polydata::array{columns[column], 1, {}}).values;
    for (const auto& row : rows) values.push_back(row[column]);
  }
  const vector_reader normal(columns, "n"), momentum(columns, "momentum"), velocity(columns, "u");
  const auto add = [&](const std::string& name, const auto& vector_of) {
    auto& values = made.data.emplace_back(polydata::array{name, 3, {}}).values;
    for (const auto& row : rows) {
      const std::array<double, 3> x = vector_of(row);
      values.insert(values.end(), x.begin(), x.end());
    }
  };
  add("normal", [&](const auto& row) { return normal.of(row); });
  if (velocity.is_there()) add("u", [&](const auto& row) { return velocity.of(row); });
  if (!momentum.is_there()) return made;
  add("momentum", [&](const auto& row) { return momentum.of(row); });
  add("tau", [&](const auto& row) {
    std::array<double, 3> along = momentum.of(row);
    const std::array<double, 3> n = normal.of(row);
    const double across = along[0] * n[0] + along[1] * n[1] + along[2] * n[2];
    for (std::size_t k = 0; k < 3; ++k) along[k] -= across * n[k];
    return along;
  });
  return made;
}

std::string to_csv(const surface_table& surface) {
  std::istringstream numbers(to_csv(surface.numbers));
  std::string line;
  std::getline(numbers, line);
  std::string text = "face," + line + "\n";
  for (const auto& face : surface.faces) {
    std::getline(numbers, line);
    text.append(face).append(",").append(line).append("\n");
  }
  return text;
}

}  // namespace apsis
