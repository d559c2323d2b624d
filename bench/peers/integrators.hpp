#pragma once

#include <apsis/integrate/any_stepper.hpp>
#include <apsis/method/time_integrator.hpp>

#include <string>
#include <vector>

namespace apsis::bench::peers {

/// Calls use(march) with the stepper of the integrator `name` for a problem; integrate(march, …) takes it.
template <problem P, class Use>
auto with_integrator(const std::string& name, P& problem, const Use& use) {
  return with_stepper(find_integrator(name), problem, [&use](auto march) { return use(march); });
}

/// Returns the names of the integrators of the library that are not Runge–Kutta methods.
inline std::vector<std::string> other_integrators() {
  auto names = names_of_several_steps();
  std::erase(names, "imex-bdf-1");  // the same as forward-backward-euler of the catalogue
  for (const auto& name : method_names())
    if (find_integrator(name).kind != "runge-kutta") names.push_back(name);
  return names;
}

}  // namespace apsis::bench::peers
