#pragma once

#include <apsis/integrate/stepper.hpp>
#include <apsis/method/time_integrator.hpp>

#include <utility>

namespace apsis {

/// Takes two steps of half the length.
template <problem P>
class planted_halves {
 public:
  explicit planted_halves(stepper<P> half) : half_(std::move(half)) {}
  void step(typename P::real t, typename P::real dt, typename P::state& u) {
    typename P::state next = u;
    half_.step(t, dt / 2, next);
    half_.step(t + dt / 2, dt / 2, next);
    std::swap(u, next);
  }

 private:
  stepper<P> half_;
};

/// The entry of stepper_kinds.
struct planted_halves_steps {
  static constexpr const char* kind = "planted-halves";  ///< integrator_kind_entry::name
  /// Returns use(march).
  template <problem P, class Use>
  static auto with(const time_integrator& m, P& p, solutions, const Use& use) {
    return use(planted_halves<P>(stepper<P>(m.starter(), p)));
  }
};

}  // namespace apsis
