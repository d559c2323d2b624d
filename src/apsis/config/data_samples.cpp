#include <apsis/config/data_samples.hpp>

#include <apsis/config/prescribed_data.hpp>
#include <apsis/mesh/grid.hpp>

#include <algorithm>
#include <cstddef>
#include <optional>

namespace apsis {

std::vector<std::vector<double>> sample_data(const case_config& config, const model& equation) {
  std::optional<prescribed_data> given;
  if (!config.prescribed.empty())
    given.emplace(config, equation, [&config](const std::string& path) { return place_of(config, path); });
  const auto& named = equation.initial();
  const auto data = std::find_if(named.begin(), named.end(), [&config](const initial_data& one) {
    return one.name == config.model.initial;
  });
  const int dimensions = equation.space_dimensions();
  case_config sampled = config;
  sampled.bodies.clear();
  sampled.solids.clear();  // their faces are on edges of the mesh of the case
  sampled.space.cells = dimensions == 0
                            ? std::vector{1}
                            : std::vector(static_cast<std::size_t>(dimensions), dimensions == 1 ? 2048 : 32);
  const grid mesh = make_mesh(sampled);
  std::vector<std::vector<double>> rows;
  for (int cell = 0; cell < mesh.size(); ++cell) {
    rows.emplace_back(static_cast<std::size_t>(equation.components()));
    const position x = dimensions == 0 ? position{} : mesh.centre(cell);
    given ? (*given)(x, rows.back()) : data->point_value(x, rows.back());
  }
  return rows;
}

}  // namespace apsis
