#include <apsis/semidiscrete/problem_builder.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/exec/interruption.hpp>
#include <apsis/scheme/quartic.hpp>
#include <apsis/semidiscrete/centre_rows.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/math/quadrature/gauss.hpp>
#include <fmt/format.h>

namespace apsis {
namespace {

struct interval {
  double centre, half;
};

/// The cell cut at the jumps that lie in it; the cell itself where there are none. A jump on an edge, up to
/// rounding, cuts nothing.
std::vector<interval> smooth_parts(const std::vector<double>& jumps, double centre, double half) {
  std::vector<double> ends = {centre - half};
  for (auto jump = std::lower_bound(jumps.begin(), jumps.end(), centre - half);
       jump != jumps.end() && *jump < centre + half; ++jump)
    if (std::abs(*jump - centre) < (1.0 - 1e-9) * half) ends.push_back(*jump);
  if (ends.size() == 1) return {{centre, half}};
  ends.push_back(centre + half);
  std::vector<interval> parts;
  for (std::size_t k = 1; k < ends.size(); ++k)
    parts.push_back({0.5 * (ends[k - 1] + ends[k]), 0.5 * (ends[k] - ends[k - 1])});
  return parts;
}

}  // namespace

problem_builder::problem_builder(const model& equation)
    : equation_(&equation), mesh_(grid::line(1, 0.0, 1.0)), epsilon_([](const position&) { return 1.0; }) {}

problem_builder& problem_builder::on(const grid& mesh) {
  if (mesh.dimensions() != equation_->space_dimensions())
    throw input_error(fmt::format("a mesh of {} dimensions (the model has {}); give one of {}",
                                  mesh.dimensions(), equation_->space_dimensions(),
                                  equation_->space_dimensions()));
  mesh_ = mesh;
  distribution_.reset();
  forget_spaces();
  const auto periodic = make_boundary("periodic");
  sides_.assign(static_cast<std::size_t>(mesh.dimensions()), {periodic, periodic});
  solids_.assign(mesh.solids().size(), nullptr);
  return *this;
}

problem_builder& problem_builder::shared_by(std::shared_ptr<communicator> processes,
                                            const std::optional<std::array<int, 3>>& blocks) {
  processes_ = std::move(processes);
  if (!has_space() && !processes_->is_single())
    throw input_error(
        fmt::format("{} processes (the model has no space to share); start one", processes_->size()));
  if (!has_space()) return *this;
  const grid whole = whole_mesh();
  const block_partition cut =
      blocks ? block_partition(whole, *blocks) : block_partition(whole, processes_->size());
  if (cut.processes() != processes_->size())
    throw input_error(
        fmt::format("{} x {} x {} blocks are {} (there are {} processes); give as many blocks as processes",
                    cut.blocks(0), cut.blocks(1), cut.blocks(2), cut.processes(), processes_->size()));
  if (processes_->is_single()) return *this;
  distribution_ = distribution{processes_, cut, whole};
  mesh_ = distribution_->block();
  forget_spaces();
  return *this;
}

problem_builder& problem_builder::with_boundary(const face& where, std::shared_ptr<const boundary> side) {
  if (where.direction < 0 || static_cast<std::size_t>(where.direction) >= sides_.size())
    throw input_error(fmt::format("no face in direction {} (the mesh has {} dimensions); call on() first",
                                  where.direction + 1, sides_.size()));
  sides_[static_cast<std::size_t>(where.direction)][where.upper ? 1 : 0] = std::move(side);
  forget_spaces();
  return *this;
}

problem_builder& problem_builder::with_solid(int number, std::shared_ptr<const boundary> wall) {
  if (number < 0 || static_cast<std::size_t>(number) >= solids_.size())
    throw input_error(
        fmt::format("no solid box {} (the mesh has {}); call on() first", number, solids_.size()));
  solids_[static_cast<std::size_t>(number)] = std::move(wall);
  forget_spaces();
  return *this;
}

problem_builder& problem_builder::with_reconstruction(std::shared_ptr<const reconstruction> scheme) {
  const int needed = 2 * scheme->ghost_width() + 1;
  for (int direction = 0; direction < mesh_.dimensions(); ++direction)
    if (const int cells = whole_mesh().cells(direction); cells < needed)
      throw input_error(
          fmt::format("a mesh of {} cells is smaller than the stencil ({} cells); give at least {}", cells,
                      needed, needed));
  discretization_.scheme = std::move(scheme);
  check_cells();
  return *this;
}

problem_builder& problem_builder::with_unknowns(formulation unknowns) {
  unknowns_ = unknowns;
  return *this;
}

problem_builder& problem_builder::with_collisions_at(collision_points points) {
  collisions_ = points;
  return *this;
}

problem_builder& problem_builder::with_positivity_limiter() {
  if (!equation_->positive())
    throw input_error(
        "the positivity limiter cannot be used (unknowns of the model may be negative); leave it out");
  limited_ = true;
  return *this;
}

problem_builder& problem_builder::with_epsilon(scale epsilon) {
  epsilon_ = std::move(epsilon);
  return *this;
}

problem_builder& problem_builder::with_smooth_collisions() {
  smooth_collisions_ = true;
  return *this;
}

problem_builder& problem_builder::with_explicit_collision() {
  explicit_collision_ = true;
  return *this;
}

problem_builder& problem_builder::with_implicit_collision() {
  stages_ = stage_solution::implicit;
  return *this;
}

problem_builder& problem_builder::with_exact_collision() {
  if (!equation_->has_exact_collision())
    throw input_error(
        "exponential methods cannot integrate this model (its collisions have no solution in closed form); "
        "choose an IMEX method");
  stages_ = stage_solution::exact;
  return *this;
}

problem_builder& problem_builder::with_force(acceleration of) {
  force_ = std::move(of);
  return *this;
}

problem_builder& problem_builder::with_source(source_rate rate) {
  if (!has_space()) throw input_error("a source needs a model with space; leave it out");
  source_ = std::move(rate);
  return *this;
}

formulation problem_builder::unknowns() const {
  return unknowns_.value_or(mesh_.dimensions() > 1 ? formulation::finite_difference
                                                   : formulation::finite_volume);
}

/// Collision on the unknowns themselves: point values, or first order, where the quartic would be too much.
bool problem_builder::pointwise() const {
  return !has_space() || first_order() || unknowns() == formulation::finite_difference;
}

spatial_discretization problem_builder::complete_discretization() const {
  spatial_discretization discretization = discretization_;
  if (limited_ && !first_order())
    discretization.positivity =
        unknowns() == formulation::finite_volume ? limiter_kind::edges : limiter_kind::fluxes;
  return discretization;
}

void problem_builder::check_solids() const {
  for (std::size_t k = 0; k < solids_.size(); ++k)
    if (!solids_[k]) throw input_error(fmt::format("solid box {} has no wall; call with_solid()", k));
}

/// For collisions at centres; with_reconstruction() checks the stencil of the reconstruction.
void problem_builder::check_cells() const {
  if (collides_at_centres() && whole_mesh().cells(0) <= centre_rows::reach)
    throw input_error(
        fmt::format("{} cells (values at their centres depend on {} neighbours); give at least {}",
                    whole_mesh().cells(0), centre_rows::reach, centre_rows::reach + 1));
}

std::shared_ptr<domain> problem_builder::make_space() const {
  check_solids();
  if (!has_space()) return std::make_shared<domain>(domain::point());
  const phase_space space{mesh_, equation_->velocities()};
  return distribution_ ? std::make_shared<domain>(space, sides_, solids_, *distribution_)
                       : std::make_shared<domain>(space, sides_, solids_);
}

const domain& problem_builder::space() const {
  if (!space_) space_ = make_space();
  return *space_;
}

const domain& problem_builder::whole_space() const {
  if (!distribution_) return space();
  check_solids();
  if (!whole_)
    whole_ = std::make_shared<domain>(phase_space{whole_mesh(), equation_->velocities()}, sides_, solids_);
  return *whole_;
}

/// In every cell at the points `offsets` · Δx from its centre, along the first direction.
std::vector<double> problem_builder::epsilon_at(std::span<const double> offsets) const {
  std::vector<double> values;
  for (int cell = 0; cell < mesh_.size(); ++cell)
    for (const double offset : offsets) {
      interruptible::poll();
      position x = has_space() ? mesh_.centre(cell) : position{};
      x[0] += offset * mesh_.spacing(0);
      values.push_back(epsilon_(x));
      if (!(values.back() >= 0.0) || !std::isfinite(values.back()))
        throw input_error(fmt::format(
            "epsilon is {} at x = {:.6g} (a finite number >= 0 is needed); change it", values.back(), x[0]));
    }
  return values;
}

std::vector<double> problem_builder::epsilon_at_centres() const {
  constexpr double centre = 0.0;
  return epsilon_at({&centre, 1});
}

std::unique_ptr<collision> problem_builder::make_collision(const std::shared_ptr<domain>& space) const {
  if (pointwise())
    return make_pointwise_collision(*equation_, epsilon_at_centres(), keeps_sign(), mesh_.fluid(), stages_);
  if (collides_at_centres())
    // Where solutions may be negative, limited averages would lose what they cut off.
    return make_cell_centre_collision(*equation_, space,
                                      keeps_sign() && !smooth_collisions_ && equation_->why_signed().empty(),
                                      epsilon_at_centres(), stages_);
  return make_cell_average_collision(*equation_, space, complete_discretization(), epsilon_at(gauss3::xi),
                                     stages_);
}

std::unique_ptr<semidiscrete_problem> problem_builder::build() const {
  if (has_space() && sides_.empty()) throw input_error("no mesh (the model has space); call on()");
  if (has_space() && !discretization_.scheme)
    throw input_error("no reconstruction (the model has space); call with_reconstruction()");
  if (has_space() && mesh_.dimensions() > 1 && unknowns() == formulation::finite_volume)
    throw input_error(fmt::format(
        "cell averages in {} space dimensions (they are collided at the Gauss points of intervals); "
        "use the finite difference formulation",
        mesh_.dimensions()));
  if (collisions_ && (!has_space() || unknowns() == formulation::finite_difference))
    throw input_error(
        "points of collisions (the unknowns are point values, which collide where they are); leave them out");
  check_cells();
  if (!mesh_.solids().empty() && !pointwise())
    throw input_error(
        "solid boxes with cell averages (they are collided on whole lines); use the finite difference "
        "formulation");
  this->space();
  // Ghost rows belong to one problem.
  const auto space = space_.use_count() > 1 ? make_space() : space_;
  auto problem = std::make_unique<semidiscrete_problem>(*equation_, space, complete_discretization(),
                                                        make_collision(space), stages_);
  if (force_) problem->set_force(*force_);
  if (source_) problem->set_source(*source_, unknowns());
  if (explicit_collision_) problem->treat_collision_explicitly();
  return problem;
}

field problem_builder::sample(const data& value, const std::vector<double>& jumps) const {
  field u(mesh_.size(), equation_->components());
  std::vector<double> values(static_cast<std::size_t>(u.components()));
  const bool averages = has_space() && unknowns() == formulation::finite_volume;
  for (int cell = 0; cell < u.cells(); ++cell) {
    interruptible::poll();
    if (mesh_.solid(cell) >= 0) continue;
    const position centre = has_space() ? mesh_.centre(cell) : position{};
    const double half = 0.5 * mesh_.spacing(0);
    double* row = u.row(cell);
    const auto add = [&](double x, double weight) {
      value({x, centre[1], centre[2]}, values);
      for (std::size_t k = 0; k < values.size(); ++k) row[k] += weight * values[k];
    };
    if (averages) {
      // Ten points on every smooth part: exact to round-off for data that the mesh resolves at all.
      using rule = boost::math::quadrature::gauss<double, 10>;
      for (const auto& part : smooth_parts(jumps, centre[0], half)) {
        for (std::size_t q = 0; q < rule::abscissa().size(); ++q) {
          const double weight = part.half / half * 0.5 * rule::weights()[q];
          add(part.centre - part.half * rule::abscissa()[q], weight);
          add(part.centre + part.half * rule::abscissa()[q], weight);
        }
      }
    } else {
      add(centre[0], 1.0);
    }
  }
  return u;
}

}  // namespace apsis
