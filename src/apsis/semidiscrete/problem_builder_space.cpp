#include <apsis/mesh/cut_cells.hpp>
#include <apsis/semidiscrete/axisymmetric.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/semidiscrete/ring_rotation.hpp>

#include <algorithm>

namespace apsis {

double problem_builder::cfl_number() const {
  const double of_limiter =
      limited_ && has_space() && !first_order() ? of_space().limited_cfl_number(collisions_) : 1.0;
  return mesh_.cut() != nullptr ? std::min(of_limiter, cut_cells::cfl_number) : of_limiter;
}

int problem_builder::ghost_rows() const {
  using limits = limited_reconstruction::limits;
  return limited_reconstruction{scheme_, limited_ && !first_order() ? limits::fluxes : limits::nothing}
      .ghosts();
}

double problem_builder::cfl_rate() const {
  if (radial_) {
    space();
    const ring_rotation turning(*equation_, space_, *radial_,
                                {scheme_, limited_reconstruction::limits::nothing});
    const auto rates = turning.rates_with(line_speeds::of(*equation_, mesh_));
    return *std::max_element(rates.begin(), rates.end());
  }
  std::vector<double> spacing;
  for (int k = 0; k < mesh_.dimensions(); ++k) spacing.push_back(mesh_.spacing(k));
  return equation_->cfl_rate(spacing);
}

std::shared_ptr<domain> problem_builder::make_space() const {
  check_solids();
  if (!has_space()) return std::make_shared<domain>(domain::point());
  return make_domain_of(mesh_, distribution_ ? &*distribution_ : nullptr);
}

std::shared_ptr<domain> problem_builder::make_domain_of(const grid& mesh, const distribution* shared) const {
  axisymmetric::check(*equation_, whole_mesh(), radial_, sides_, of_space().unknown());
  const auto sides = radial_ ? axisymmetric::sides_of(sides_, *radial_, mesh) : sides_;
  const auto solids = radial_ ? axisymmetric::walls_of(solids_, *radial_, mesh) : solids_;
  const phase_space space{mesh, equation_->velocities()};
  return shared ? std::make_shared<domain>(space, sides, solids, *shared)
                : std::make_shared<domain>(space, sides, solids);
}

const domain& problem_builder::space() const {
  if (!space_) space_ = make_space();
  return *space_;
}

const domain& problem_builder::whole_space() const {
  if (!distribution_) return space();
  check_solids();
  if (!whole_) whole_ = make_domain_of(whole_mesh(), nullptr);
  return *whole_;
}

}  // namespace apsis
