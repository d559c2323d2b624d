#include <apsis/verify/conserved_fields.hpp>

#include <apsis/core/extremes.hpp>

#include <cmath>

namespace apsis {

conserved_fields conserved(const field_table& macroscopic) {
  conserved_fields result;
  for (std::size_t i = 0; i < macroscopic.x.size(); ++i) {
    const double rho = macroscopic.values[0][i], u = macroscopic.values[1][i], T = macroscopic.values[2][i];
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
