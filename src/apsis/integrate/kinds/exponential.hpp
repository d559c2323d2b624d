#pragma once

#include <apsis/integrate/exact_collisions.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/time_integrator.hpp>

#include <memory>

namespace apsis {

/// @cond
namespace exponential_parts {

template <class P>
struct wrapped {
  std::unique_ptr<exact_collisions<P>> exact;  // its address survives a move
};

/// A stepper of the wrapped problem that owns the wrapper.
template <problem_with_known_collision P>
class owning_stepper : private wrapped<P>, public stepper<exact_collisions<P>> {
 public:
  owning_stepper(const method& m, P& p, solutions which)
      : wrapped<P>{std::make_unique<exact_collisions<P>>(p)},
        stepper<exact_collisions<P>>(m, *wrapped<P>::exact, which) {}
};

}  // namespace exponential_parts
/// @endcond

/// Entry of stepper_kinds: a stepper of a problem with exact collisions. A problem with a known collision
/// that solves stages in another way is wrapped in exact_collisions.
struct exponential_steps {
  static constexpr const char* kind = "exponential";  ///< integrator_kind_entry::name
  /// Returns use(march).
  template <problem P, class Use>
  static auto with(const time_integrator& m, P& p, solutions which, const Use& use) {
    if constexpr (problem_with_known_collision<P>)
      return use(exponential_parts::owning_stepper<P>(m.starter(), p, which));
    else
      return use(stepper<P>(m.starter(), p, which));
  }
};

}  // namespace apsis
