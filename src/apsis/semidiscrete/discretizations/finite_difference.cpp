#include <apsis/semidiscrete/discretization_registry.hpp>
#include <apsis/semidiscrete/upwind_transport.hpp>

namespace apsis {
namespace {

/// Point values at the centres of cells, which collide where they are; also of models without space.
class finite_differences final : public discretization {
 public:
  const cell_unknown& unknown() const override { return point_values(); }

  collision_layout collisions_at(const std::string&, const reconstruction&) const override {
    return {unknown().points()};
  }

  std::unique_ptr<transport> make_transport(const problem_parts& of) const override {
    using limits = limited_reconstruction::limits;
    return std::make_unique<upwind_transport>(
        of.equation, of.space,
        limited_reconstruction{of.scheme, of.limited && !of.first_order() ? limits::fluxes : limits::nothing},
        unknown());
  }

  std::unique_ptr<collision> make_collision(const problem_parts& of) const override {
    return make_pointwise_collision(of.equation, of.epsilon_at(unknown().points()), of.keeps_sign(),
                                    of.space->mesh().fluid(), of.stages);
  }
};

}  // namespace

extern const discretization_entry discretization_finite_difference;
const discretization_entry discretization_finite_difference = {
    .name = "finite-difference",
    .description = "point values at the centres of cells, with numerical fluxes at their edges",
    .source = "Shu, Osher, JCP 83 (1989); Xu, Math. Comp. 83 (2014)",
    .instance = instance_of<finite_differences>};

}  // namespace apsis
