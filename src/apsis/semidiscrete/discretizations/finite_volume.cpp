#include <apsis/semidiscrete/centre_rows.hpp>
#include <apsis/semidiscrete/discretization_registry.hpp>
#include <apsis/semidiscrete/upwind_transport.hpp>

namespace apsis {
namespace {

constexpr const char *gauss_points = "gauss", *cell_centres = "centres";

/// Cell averages on a line. They collide at points with values from the reconstruction or from all averages
/// together. With first-order upwind such values would be no more accurate than the average, so that each
/// average collides itself.
class finite_volumes final : public discretization {
 public:
  const cell_unknown& unknown() const override { return cell_averages(); }
  std::string why_on_a_line() const override {
    return "cell averages collide at the Gauss points of intervals";
  }
  std::string why_without_solids() const override { return "cell averages are collided on whole lines"; }
  std::vector<std::string> collision_places() const override { return {gauss_points, cell_centres}; }

  collision_layout collisions_at(const std::string& place, const reconstruction& scheme) const override {
    if (scheme.order() == 1) return {point_values().points()};
    if (place == cell_centres) return {point_values().points(), false, centre_rows::reach};
    return {cell_averages().points(), false};
  }

  double limited_cfl_number(const std::string& place) const override {
    return limited_reconstruction{nullptr, limits_at(place)}.kappa();
  }

  std::unique_ptr<transport> make_transport(const problem_parts& of) const override {
    return std::make_unique<upwind_transport>(of.equation, of.space, edges(of), unknown());
  }

  std::unique_ptr<collision> make_collision(const problem_parts& of) const override {
    auto epsilon = of.epsilon_at(collisions_at(of.collisions, *of.scheme).points);
    if (of.first_order())
      return make_pointwise_collision(of.equation, std::move(epsilon), of.keeps_sign(),
                                      of.space->mesh().fluid(), of.stages);
    if (of.collisions == cell_centres) {
      // If solutions may be negative, limited averages would lose the parts that are cut off.
      const bool limited = of.limited && !of.smooth_collisions && of.equation.why_signed().empty();
      return make_cell_centre_collision(of.equation, of.space, limited, std::move(epsilon), of.stages);
    }
    return make_cell_average_collision(of.equation, of.space, edges(of), std::move(epsilon), of.stages);
  }

 private:
  using limits = limited_reconstruction::limits;
  /// Gauss points need edge values that are consistent with the average. Everything else needs only fluxes.
  static limits limits_at(const std::string& place) {
    return place == cell_centres ? limits::fluxes : limits::edges;
  }
  static limited_reconstruction edges(const problem_parts& of) {
    return {of.scheme, of.limited && !of.first_order() ? limits_at(of.collisions) : limits::nothing};
  }
};

}  // namespace

extern const discretization_entry discretization_finite_volume;
const discretization_entry discretization_finite_volume = {
    .name = "finite-volume",
    .description = "cell averages on a line, with edge values of the solution",
    .source = "Shu, NASA/CR-97-206253 (1997); Zhang, Shu, JCP 229 (2010)",
    .instance = instance_of<finite_volumes>};

}  // namespace apsis
