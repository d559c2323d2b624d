#include <apsis/model/mean_free_path.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace apsis {

using std::numbers::pi, std::numbers::sqrt2;

const std::vector<mean_free_path>& mean_free_paths() {
  // Kn/ε, in units of √(RT) and L with μ/p = ε.
  static const std::vector<mean_free_path> all = {
      {"viscosity", "mu sqrt(pi R T/2)/p",
       "from the viscosity mu = rho c lambda/2 with the mean speed c = sqrt(8 R T/pi)",
       [](double) { return std::sqrt(pi / 2.0); }},
      {"mean-speed", "mu sqrt(8 R T/pi)/p",
       "mean speed over collision frequency p/mu of the BGK model (Sone 2007)",
       [](double) { return std::sqrt(8.0 / pi); }},
      {"vhs", "(2/15)(7 - 2 w)(5 - 2 w) mu/(rho sqrt(2 pi R T))",
       "variable hard spheres with the viscosity exponent w (Bird 1994, eq. 4.65)",
       [](double w) { return 2.0 / 15.0 * (7.0 - 2.0 * w) * (5.0 - 2.0 * w) / std::sqrt(2.0 * pi); }},
      {"hard-sphere", "(16/5) mu/(rho sqrt(2 pi R T))",
       "hard spheres, first approximation of Chapman and Enskog (Bird 1994, eq. 4.52)",
       [](double) { return 16.0 / 5.0 / std::sqrt(2.0 * pi); }},
      {"equivalent", "mu sqrt(2 R T)/p",
       "equivalent free path of kinetic tables (Sharipov 2016): lambda/L = k = 1/delta",
       [](double) { return sqrt2; }}};
  return all;
}

std::vector<std::string> mean_free_path_names() {
  std::vector<std::string> names;
  for (const auto& one : mean_free_paths()) names.push_back(one.name);
  return names;
}

const mean_free_path* try_find_mean_free_path(const std::string& name) {
  const auto& all = mean_free_paths();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

double rarefaction_of_epsilon(double epsilon) {
  return 1.0 / (sqrt2 * epsilon);
}

}  // namespace apsis
