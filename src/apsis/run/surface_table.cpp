#include <apsis/run/surface_table.hpp>

#include <sstream>

namespace apsis {

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
