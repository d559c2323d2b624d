#include <apsis/semidiscrete/discretization_registry.hpp>
#include <apsis/semidiscrete/upwind_transport.hpp>

#include <utility>

namespace apsis {
namespace {

/// Point values at the centres of cells, where they also collide. This discretization also serves
/// models without space.
class finite_differences final : public discretization {
 public:
  const cell_unknown& unknown() const override { return point_values(); }

  collision_layout collisions_at(const std::string&, const reconstruction&) const override {
    return {unknown().points()};
  }

  double limited_cfl_number(const std::string&) const override { return limits_of(true).kappa(); }

  std::unique_ptr<transport> make_transport(const problem_parts& of) const override {
    limited_reconstruction edges = limits_of(of.limited && !of.first_order());
    edges.scheme = of.scheme;
    return std::make_unique<upwind_transport>(of.equation, of.space, std::move(edges), unknown());
  }

  std::unique_ptr<collision> make_collision(const problem_parts& of) const override {
    return make_pointwise_collision(of.equation, of.epsilon_at(unknown().points()), of.keeps_sign(),
                                    of.space->mesh().fluid(), of.stages);
  }

 private:
  static limited_reconstruction limits_of(bool limited) {
    using limits = limited_reconstruction::limits;
    return {nullptr, limited ? limits::fluxes : limits::nothing};
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
