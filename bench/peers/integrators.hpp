#pragma once

#include <apsis/integrate/exponential.hpp>
#include <apsis/integrate/multistep_formula.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/multistep.hpp>

#include <string>
#include <vector>

namespace apsis::bench::peers {

/// Calls use(march) with the integrator called `name` of a problem, for integrate(march, …): that of a
/// multistep method, or the stepper of a method of the catalogue or of a family. For exponential methods, a
/// problem that knows its collision solves it exactly.
template <problem P, class Use>
auto with_integrator(const std::string& name, P& problem, const Use& use) {
  if (is_multistep_method(name))
    return with_multistep_formula(find_multistep_method(name), problem,
                                  [&use](auto march) { return use(march); });
  const method& m = find_method(name);
  if constexpr (problem_with_known_collision<P>)
    if (m.kind == method_kind::exponential) {
      exact_collisions exact(problem);
      stepper march(m, exact);
      return use(march);
    }
  stepper march(m, problem);
  return use(march);
}

/// Returns the names of the multistep and exponential methods of the library.
inline std::vector<std::string> other_integrators() {
  auto names = multistep_method_names();
  std::erase(names, "imex-bdf-1");  // forward-backward-euler, which is in the catalogue
  for (const auto& name : method_names())
    if (find_method(name).kind == method_kind::exponential) names.push_back(name);
  return names;
}

}  // namespace apsis::bench::peers
