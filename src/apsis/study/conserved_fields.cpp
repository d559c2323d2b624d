#include <apsis/study/conserved_fields.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/extremes.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace apsis {
namespace {

const std::vector<double>& field_called(const std::string& name, const field_table& fields) {
  const auto found = std::find(fields.names.begin(), fields.names.end(), name);
  if (found == fields.names.end())
    throw input_error(fmt::format(
        "there is no field '{}' (density, velocity and temperature of one velocity dimension are needed); "
        "give results of such a model",
        name));
  return fields.values[static_cast<std::size_t>(found - fields.names.begin())];
}

}  // namespace

conserved_fields conserved(const field_table& macroscopic) {
  const auto &density = field_called("rho", macroscopic), &velocity = field_called("u", macroscopic),
             &temperature = field_called("T", macroscopic);
  conserved_fields result;
  for (std::size_t i = 0; i < macroscopic.x.size(); ++i) {
    const double rho = density[i], u = velocity[i], T = temperature[i];
    result[0].push_back(rho);
    result[1].push_back(rho * u);
    result[2].push_back(0.5 * rho * (u * u + T));
  }
  return result;
}

conserved_fields averaged_in_pairs(const conserved_fields& fine) {
  conserved_fields coarse;
  for (std::size_t k = 0; k < fine.size(); ++k)
    for (std::size_t i = 0; i + 1 < fine[k].size(); i += 2)
      coarse[k].push_back(0.5 * (fine[k][i] + fine[k][i + 1]));
  return coarse;
}

double largest_difference(const conserved_fields& a, const conserved_fields& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    for (std::size_t i = 0; i < a[k].size(); ++i) largest = maximum(largest, std::abs(a[k][i] - b[k].at(i)));
  return largest;
}

}  // namespace apsis
