#include <apsis/semidiscrete/discretization_registry.hpp>
#include <apsis/semidiscrete/upwind_transport.hpp>

namespace apsis {
namespace {

/// Cell averages collide like point values. The scheme is of second order in space, because an average
/// differs from the value at the centre by Δx² u''/24.
class averages_as_they_are final : public discretization {
 public:
  const cell_unknown& unknown() const override { return cell_averages(); }
  std::string why_on_a_line() const override { return "planted averages are those of intervals"; }

  collision_layout collisions_at(const std::string&, const reconstruction&) const override {
    return {point_values().points()};
  }

  double limited_cfl_number(const std::string&) const override { return 1.0; }

  std::unique_ptr<transport> make_transport(const problem_parts& of) const override {
    using limits = limited_reconstruction::limits;
    const auto limited = of.limited && !of.first_order() ? limits::fluxes : limits::nothing;
    return std::make_unique<upwind_transport>(of.equation, of.space,
                                              limited_reconstruction{of.scheme, limited}, unknown());
  }

  std::unique_ptr<collision> make_collision(const problem_parts& of) const override {
    return make_pointwise_collision(of.equation, of.epsilon_at(point_values().points()), of.keeps_sign(),
                                    of.space->mesh().fluid(), of.stages);
  }
};

}  // namespace

extern const discretization_entry discretization_planted_averages;
const discretization_entry discretization_planted_averages = {
    .name = "planted-averages",
    .description = "cell averages on a line that collide as they are, of second order",
    .source = "LeVeque, Finite Volume Methods for Hyperbolic Problems (2002)",
    .instance = instance_of<averages_as_they_are>};

}  // namespace apsis
