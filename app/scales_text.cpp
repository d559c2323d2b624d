#include "scales_text.hpp"

#include <apsis/model/mean_free_path.hpp>

#include <fmt/format.h>

namespace apsis::app {

std::string scales_text(const gas_scales& scales) {
  std::string out = fmt::format("{:<22}{}\n", "gas", scales.gas().name.empty() ? "own" : scales.gas().name);
  for (const auto& one : scales.quantities()) {
    if (one.name == "epsilon") break;  // knudsen_text() has the rest
    out += fmt::format("{:<22}{:.6g}{}\n", one.name, one.value,
                       one.dimension == dimensions::none ? "" : " " + unit_of(one.dimension));
  }
  return out;
}

std::string knudsen_text(double epsilon, double viscosity_exponent) {
  std::string out =
      fmt::format("{:<22}{:<14}{}\n", "epsilon", fmt::format("{:.6g}", epsilon), "mu sqrt(R T)/(p L)");
  out += fmt::format("{:<22}{:<14}{}\n", "rarefaction",
                     fmt::format("{:.6g}", rarefaction_of_epsilon(epsilon)), "delta = p L/(mu sqrt(2 R T))");
  for (const auto& one : mean_free_paths())
    out +=
        fmt::format("{:<22}{:<14}lambda = {}\n", "Kn, " + one.name,
                    fmt::format("{:.6g}", one.knudsen_of_epsilon(viscosity_exponent) * epsilon), one.formula);
  return out;
}

}  // namespace apsis::app
