#pragma once

#include <apsis/integrate/exponential.hpp>
#include <apsis/integrate/imex_bdf.hpp>
#include <apsis/integrate/two_step.hpp>
#include <apsis/method/method.hpp>

#include <string>
#include <vector>

namespace apsis::bench::peers {

/// Name of the exponential method of second order.
inline const std::string exponential_name = "exponential-2";
/// Name of the method that takes the first steps of two-step methods.
inline const std::string starter_name = "md-imex-10-3-mixed";

/// Calls use(march) with the integrator called `name` of a problem, for integrate(march, …): IMEX-BDF of
/// order k
/// ("imex-bdf-k"), or a two-step method, or the stepper of a method of the catalogue or of a family, or the
/// exponential method if the problem solves its collision exactly.
template <problem P, class Use>
auto with_integrator(const std::string& name, P& problem, const Use& use) {
  if (name.starts_with("imex-bdf-")) {
    imex_bdf march(name.back() - '0', problem);
    return use(march);
  }
  if constexpr (problem_with_exact_collision<P>)
    if (name == exponential_name) {
      exact_collisions exact(problem);
      stepper march(exponential_method<typename P::real>(), method_kind::imex, exact, name);
      return use(march);
    }
  if (is_two_step_method(name)) {
    two_step march(find_two_step_method(name), find_method(starter_name), problem);
    return use(march);
  }
  stepper march(find_method(name), problem);
  return use(march);
}

/// Returns the names of the integrators of the library that are not in the catalogue.
inline std::vector<std::string> other_integrators() {
  auto names = two_step_method_names();
  names.insert(names.end(), {"imex-bdf-2", "imex-bdf-3", "imex-bdf-4", "imex-bdf-5", exponential_name});
  return names;
}

}  // namespace apsis::bench::peers
