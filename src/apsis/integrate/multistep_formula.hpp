#pragma once

#include <apsis/integrate/imex_bdf.hpp>
#include <apsis/integrate/two_step.hpp>
#include <apsis/method/multistep.hpp>

namespace apsis {

/// Returns use(formula) with the integrator of a multistep method for a problem, an imex_bdf or a two_step;
/// `use` may move it. Stores a reference to the problem.
template <problem P, class Use>
auto with_multistep_formula(const multistep_method& m, P& p, const Use& use) {
  if (m.rows) return use(two_step<P>(*m.rows, find_method(m.starter), p));
  return use(imex_bdf<P>(m.order, p));
}

}  // namespace apsis
