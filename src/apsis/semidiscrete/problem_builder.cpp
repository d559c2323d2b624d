#include <apsis/semidiscrete/problem_builder.hpp>

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/core/printable.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/exec/interruption.hpp>
#include <apsis/semidiscrete/axisymmetric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace apsis {

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
  solids_.assign(at(mesh.obstacles()), nullptr);
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
        fmt::format("no solid box or body {} (the mesh has {}); call on() first", number, solids_.size()));
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
  scheme_ = std::move(scheme);
  check_cells();
  return *this;
}

problem_builder& problem_builder::with_discretization(const std::string& name) {
  discretization_ = &find_discretization(name);
  own_discretization_ = nullptr;
  return *this;
}

problem_builder& problem_builder::with_discretization(std::shared_ptr<const discretization> of_space) {
  own_discretization_ = std::move(of_space);
  return *this;
}

problem_builder& problem_builder::with_collisions_at(const std::string& place) {
  collisions_ = place;
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

problem_builder& problem_builder::with_epsilon_times(double factor) {
  return with_epsilon([factor, epsilon = epsilon_](const position& x) { return factor * epsilon(x); });
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
        "methods with exact collisions cannot integrate this model (it has no collisions in closed form); "
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

problem_builder& problem_builder::with_axis(int radial) {
  radial_ = radial;
  forget_spaces();
  return *this;
}

const discretization& problem_builder::of_space() const {
  if (has_space() && own_discretization_) return *own_discretization_;
  const bool chosen = has_space() && discretization_ != nullptr;
  return (chosen ? *discretization_ : default_discretization(equation_->space_dimensions())).instance();
}

collision_layout problem_builder::collisions() const {
  if (!has_space()) return {point_values().points()};
  return of_space().collisions_at(collisions_, *scheme_);
}

void problem_builder::check_solids() const {
  for (std::size_t k = 0; k < solids_.size(); ++k)
    if (!solids_[k])
      throw input_error(fmt::format("{} {} has no wall; call with_solid()",
                                    k < mesh_.solids().size() ? "solid box" : "body",
                                    k < mesh_.solids().size() ? k : k - mesh_.solids().size()));
}

/// Checks the number of cells for collisions; with_reconstruction() checks it for the reconstruction.
void problem_builder::check_cells() const {
  const int reach = scheme_ ? collisions().reach : 0;
  if (reach > 0 && whole_mesh().cells(0) <= reach)
    throw input_error(
        fmt::format("{} cells (values at their centres depend on {} neighbours); give at least {}",
                    whole_mesh().cells(0), reach, reach + 1));
}

void problem_builder::check_discretization() const {
  const discretization& chosen = of_space();
  const std::string otherwise = "use finite differences";
  if (const std::string why = chosen.why_on_a_line(); mesh_.dimensions() > 1 && !why.empty())
    throw input_error(fmt::format("{} in {} space dimensions ({}); {}", chosen.unknown().plural(),
                                  mesh_.dimensions(), why, otherwise));
  const auto places = chosen.collision_places();
  if (!collisions_.empty() && places.empty())
    throw input_error(fmt::format(
        "points of collisions (the unknowns are {}, which collide where they are); leave them out",
        chosen.unknown().plural()));
  if (!collisions_.empty() && std::find(places.begin(), places.end(), collisions_) == places.end())
    throw input_error(fmt::format("unknown collisions '{}' (there is no such name); {}",
                                  printable(collisions_), suggest(collisions_, places)));
  check_cells();
  if (const std::string why = chosen.why_without_solids();
      mesh_.obstacles() > 0 && !why.empty() && !collisions().cellwise)
    throw input_error(fmt::format("solid boxes with {} ({}); {}", chosen.unknown().plural(), why, otherwise));
}

/// Returns ε at the points of every cell along the first direction.
std::vector<double> problem_builder::epsilon_at(std::span<const weighted_point> points,
                                                const scale& epsilon) const {
  std::vector<double> values;
  for (int cell = 0; cell < mesh_.size(); ++cell)
    for (const auto& [offset, weight] : points) {
      interruptible::poll();
      position x = has_space() ? mesh_.centre(cell) : position{};
      x[0] += offset * mesh_.spacing(0);
      values.push_back(epsilon(x));
      if (!(values.back() >= 0.0) || !std::isfinite(values.back()))
        throw input_error(fmt::format(
            "epsilon is {} at x = {:.6g} (a finite number >= 0 is needed); change it", values.back(), x[0]));
    }
  return values;
}

std::vector<double> problem_builder::epsilon_at_centres() const {
  return epsilon_at(point_values().points(), epsilon_);
}

std::vector<double> problem_builder::epsilon_of_unknowns() const {
  return epsilon_at(point_values().points(),
                    radial_ ? axisymmetric::epsilon_of(epsilon_, *equation_, *radial_) : epsilon_);
}

std::unique_ptr<semidiscrete_problem> problem_builder::build() const {
  if (has_space() && sides_.empty()) throw input_error("no mesh (the model has space); call on()");
  if (has_space() && !scheme_)
    throw input_error("no reconstruction (the model has space); call with_reconstruction()");
  check_discretization();
  if (radial_ && force_)
    throw input_error(
        "a force in axisymmetric flow (rings of velocities have no lattice along which it acts); leave it "
        "out");
  this->space();
  // Each problem needs its own ghost rows.
  const auto space = space_.use_count() > 1 ? make_space() : space_;
  const scale epsilon = radial_ ? axisymmetric::epsilon_of(epsilon_, *equation_, *radial_) : epsilon_;
  const problem_parts parts{.equation = *equation_,
                            .space = space,
                            .scheme = scheme_,
                            .limited = limited_,
                            .smooth_collisions = smooth_collisions_,
                            .collisions = collisions_,
                            .stages = stages_,
                            .epsilon_at = [&](auto points) { return epsilon_at(points, epsilon); }};
  const discretization& chosen = of_space();
  auto problem = std::make_unique<semidiscrete_problem>(*equation_, space, chosen.make_transport(parts),
                                                        chosen.make_collision(parts), stages_);
  if (force_) problem->set_force(*force_);
  if (radial_) problem->set_rotation(*radial_);
  if (source_) problem->set_source(radial_ ? axisymmetric::source_of(*source_, *radial_) : *source_);
  if (explicit_collision_) problem->treat_collision_explicitly();
  return problem;
}

field problem_builder::sample(const data& value, const std::vector<double>& jumps) const {
  field u(mesh_.size(), equation_->components());
  std::vector<double> values(static_cast<std::size_t>(u.components()));
  const cell_unknown& unknown = of_space().unknown();
  const data unknowns = radial_ ? axisymmetric::data_of(value, *radial_) : value;
  for (int cell = 0; cell < u.cells(); ++cell) {
    interruptible::poll();
    if (mesh_.solid(cell) >= 0) continue;
    const position centre = has_space() ? mesh_.centre(cell) : position{};
    unknown.sample(unknowns, jumps, centre, mesh_.spacing(0), values, u.row(cell));
  }
  return u;
}

}  // namespace apsis
