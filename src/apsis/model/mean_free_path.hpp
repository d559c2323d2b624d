#pragma once

#include <string>
#include <vector>

namespace apsis {

/// A definition of the mean free path λ of a gas with viscosity μ = ε T^ω, where ε = μ √(RT)/(p L). It also
/// defines the Knudsen number Kn = λ/L at the reference state.
struct mean_free_path {
  std::string name;                        ///< name in a case file (model.knudsen.mean_free_path)
  std::string formula;                     ///< λ, in ASCII
  std::string description;                 ///< one line with the source
  double (*knudsen_of_epsilon)(double w);  ///< returns Kn/ε for a viscosity exponent ω
};

/// Returns all definitions in use; for argon the largest is 1.65 times the smallest.
const std::vector<mean_free_path>& mean_free_paths();

/// Returns the names of mean_free_paths().
std::vector<std::string> mean_free_path_names();

/// Returns the definition called `name`; nullptr for an unknown name.
const mean_free_path* try_find_mean_free_path(const std::string& name);

/// Returns the rarefaction parameter δ = p L/(μ √(2RT)) = 1/(√2 ε); ∞ for ε = 0.
double rarefaction_of_epsilon(double epsilon);

}  // namespace apsis
