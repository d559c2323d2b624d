#pragma once

#include <apsis/integrate/exponential.hpp>
#include <apsis/integrate/multistep_formula.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/multistep.hpp>

#include <string>
#include <vector>

namespace apsis::bench::peers {

/// Name of the exponential method of second order.
inline const std::string exponential_name = "exponential-2";

/// Calls use(march) with the integrator called `name` of a problem, for integrate(march, …): that of a
/// multistep method, or the stepper of a method of the catalogue or of a family, or the exponential method if
/// the problem solves its collision exactly.
template <problem P, class Use>
auto with_integrator(const std::string& name, P& problem, const Use& use) {
  if (is_multistep_method(name))
    return with_multistep_formula(find_multistep_method(name), problem,
                                  [&use](auto march) { return use(march); });
  if constexpr (problem_with_exact_collision<P>)
    if (name == exponential_name) {
      exact_collisions exact(problem);
      stepper march(exponential_method<typename P::real>(), method_kind::imex, exact, name);
      return use(march);
    }
  stepper march(find_method(name), problem);
  return use(march);
}

/// Returns the names of the integrators of the library that are not in the catalogue.
inline std::vector<std::string> other_integrators() {
  auto names = multistep_method_names();
  std::erase(names, "imex-bdf-1");  // forward-backward-euler, which is in the catalogue
  names.push_back(exponential_name);
  return names;
}

}  // namespace apsis::bench::peers
