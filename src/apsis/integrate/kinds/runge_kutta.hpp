#pragma once

#include <apsis/integrate/stepper.hpp>
#include <apsis/method/time_integrator.hpp>

namespace apsis {

/// Entry of stepper_kinds: a stepper.
struct runge_kutta_steps {
  static constexpr const char* kind = "runge-kutta";  ///< integrator_kind_entry::name
  /// Returns use(march).
  template <problem P, class Use>
  static auto with(const time_integrator& m, P& p, solutions which, const Use& use) {
    return use(stepper<P>(m.starter(), p, which));
  }
};

}  // namespace apsis
