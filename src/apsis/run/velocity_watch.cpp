#include <apsis/run/velocity_watch.hpp>

#include <apsis/config/boundary_support.hpp>
#include <apsis/config/force_reader.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/mesh/on_host.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double least_share_of_density = 1e-3, fewest_collisions = 0.1;

/// Returns the volume of the gas in the whole mesh.
double volume_of_gas(const run_setup& setup) {
  double cells = 0.0;
  for (const cell_range& range : setup.whole_mesh().fluid())
    for (int cell = range.begin; cell < range.end; ++cell) cells += setup.whole_mesh().gas_share(cell);
  return cells * setup.cell_volume();
}

/// Returns the negative part of the mass of a row.
double negative_mass(const gas& molecules, const double* row) {
  const auto weights = molecules.velocities().weights();
  double sum = 0.0;
  for (std::size_t j = 0; j < weights.size(); ++j) sum += weights[j] * std::max(-row[j], 0.0);
  return sum;
}

bool has_walls(const case_config& config) {
  if (!config.solids.empty() || !config.bodies.empty()) return true;
  for (std::size_t k = 0; k < 2 * config.space.cells.size(); ++k) {
    const std::string kind = config.faces[k].kind.value_or(config.space.boundary);
    if (kind == "diffuse" || kind == "symmetry" || kind == "adiabatic" || kind == "radiating") return true;
  }
  return false;
}

}  // namespace

void velocity_extremes::add(const velocity_extremes& other) {
  if (std::tie(other.margins.room, other.room_cell) < std::tie(margins.room, room_cell)) {
    margins.room = other.margins.room;
    room_cell = other.room_cell;
  }
  if (std::tie(other.margins.resolution, other.resolution_cell) <
      std::tie(margins.resolution, resolution_cell)) {
    margins.resolution = other.margins.resolution;
    resolution_cell = other.resolution_cell;
  }
}

velocity_watch::velocity_watch(const run_setup& setup)
    : setup_(setup), support_(support_of(*setup.equation)) {
  if (!support_) return;
  epsilon_ = setup.epsilon_at_centres();
  volume_ = volume_of_gas(setup);
}

void velocity_watch::set_mass(double mass) {
  least_density_ = least_share_of_density * mass / volume_;
}

bool velocity_watch::collides(int cell, const double* omega) const {
  const auto& relaxation = *setup_.equation->as_relaxation();
  return relaxation.rate(omega) * setup_.config().time.end >=
         fewest_collisions * epsilon_[static_cast<std::size_t>(cell)];
}

void velocity_watch::look(const double* omega, int cell, velocity_extremes& own) const {
  if (!(omega[0] >= least_density_)) return;
  const velocity_margins here = support_->margins(omega);
  if (!(here.room <= own.margins.room) && !(here.resolution <= own.margins.resolution)) return;
  if (velocity_support::is_safe(here) || collides(cell, omega)) own.add({here, cell, cell});
}

/// Returns the state of a cell of one process; the others pass `none`. Returns nothing if an unstable step
/// has made the state negative.
std::optional<velocity_watch::candidate> velocity_watch::shared(int cell, const field& u) const {
  const bool mine = cell != velocity_extremes::none;
  const gas& molecules = support_->molecules();
  std::vector<double> omega(static_cast<std::size_t>(molecules.moment_count())), room;
  const double* row = mine ? row_on_host(u, cell, room).data() : nullptr;
  if (mine) molecules.moments(row, 0, 1, omega.data());
  omega.push_back(mine ? negative_mass(molecules, row) : 0.0);
  const auto worst =
      worst_of_all(setup_.processes(), 1.0, mine ? setup_.number_in_whole_mesh(cell) : -1, omega);
  candidate found{worst ? worst->cell : -1, {}, {}};
  constexpr double harmless = 0.01;
  if (!worst || worst->omega.back() > harmless * worst->omega.front()) return std::nullopt;
  const auto fit = support_->fit_of_moments(worst->omega.data(), found.state);
  if (!fit) return std::nullopt;
  found.fit = *fit;
  return found;
}

/// Returns the states of cells that fit worse than all before, and enters their numbers into the totals.
std::vector<velocity_watch::candidate> velocity_watch::new_extremes(const velocity_extremes& mine,
                                                                    const velocity_margins& margins,
                                                                    const field& u,
                                                                    run_summary& totals) const {
  const double room = std::sqrt(margins.room), resolution = std::sqrt(margins.resolution);
  const bool less_room = room < totals.velocity_room, coarser = resolution < totals.velocity_resolution;
  std::vector<candidate> found;
  const auto add = [&](bool worse, int cell, double own, double of_all) {
    if (!worse) return;
    if (const auto one = shared(own == of_all ? cell : velocity_extremes::none, u)) found.push_back(*one);
  };
  if (less_room) {
    totals.velocity_room = room;
    totals.velocity_beyond = std::max(totals.velocity_beyond, 0.5 * std::erfc(room / std::numbers::sqrt2));
  }
  if (coarser) totals.velocity_resolution = resolution;
  add(less_room && room < velocity_support::safe_room, mine.room_cell, mine.margins.room, margins.room);
  add(coarser && resolution < velocity_support::safe_resolution, mine.resolution_cell,
      mine.margins.resolution, margins.resolution);
  for (const candidate& one : found) {
    totals.velocity_beyond = std::max(totals.velocity_beyond, one.fit.beyond);
    totals.velocity_missed = std::max(totals.velocity_missed, one.fit.missed);
    for (int k = 0; k < support_->molecules().dimensions(); ++k)
      totals.velocity_needed = std::max(totals.velocity_needed, velocity_needed(one.state.u[k], one.state.T));
  }
  return found;
}

void velocity_watch::start(const velocity_extremes& mine, const velocity_margins& margins, const field& u,
                           run_summary& totals) {
  if (!active()) return;
  for (const candidate& one : new_extremes(mine, margins, u, totals))
    if (one.fit.missed > velocity_limits::good) warned(one.fit) = true;
}

void velocity_watch::update(const velocity_extremes& mine, const velocity_margins& margins, const field& u,
                            const step_record& at, run_summary& totals) {
  if (!active()) return;
  for (const candidate& one : new_extremes(mine, margins, u, totals)) judge(one, u, at);
}

void velocity_watch::judge(const candidate& worst, const field& u, const step_record& at) {
  if (!(worst.fit.missed > velocity_limits::good)) return;
  const bool hopeless = worst.fit.ends && worst.fit.missed > velocity_limits::bad;
  if (!hopeless && warned(worst.fit)) return;
  warned(worst.fit) = true;
  velocity_words words =
      words_of(setup_.config(),
               hopeless ? "the gas" : fmt::format("the gas in cell {} at t = {:.6g}", worst.cell, at.t));
  words.needed = velocity_that_would_do(u, at);
  const std::string problem = velocity_problem(support_->molecules(), worst.state, worst.fit, words).problem;
  if (hopeless) throw numerical_error(problem, {at.step, at.t, worst.cell, worst.state.T});
  log::warning(problem);
}

void velocity_watch::add_held(double share, const field& u, const step_record& at,
                              run_summary& totals) const {
  constexpr double much = 0.01;
  const double before = totals.velocity_held;
  totals.velocity_held += share;
  if (!(before <= much && totals.velocity_held > much)) return;
  const double needed = velocity_that_would_do(u, at);
  log::warning(
      fmt::format("the force moves the gas into the ends of the velocity grid (a fraction {:.2g} of its mass "
                  "until t = {:.6g}, "
                  "which cannot leave there); give {}",
                  totals.velocity_held, at.t, larger_velocities(needed)));
}

void velocity_watch::add_lost(const field& u, const step_record& at, run_summary& totals) {
  constexpr double much = 0.01;
  const auto [momentum, energy] = at.lost_share;
  const bool iterates = setup_.config().steady_state.tolerance.has_value();
  totals.force_lost_momentum = iterates ? momentum : std::max(totals.force_lost_momentum, momentum);
  totals.force_lost_energy = iterates ? energy : std::max(totals.force_lost_energy, energy);
  // Fluxes of first order diffuse f along v, which heats the gas at any range of velocities.
  const bool of_energy = energy > momentum && !setup_.builder().first_order();
  const double share = of_energy ? energy : momentum;
  if (warned_of_loss_ || !(share > much)) return;
  warned_of_loss_ = true;
  const double needed = velocity_that_would_do(u, at);
  log::warning(fmt::format(
      "the force gives the gas less {} than it should (by a fraction {:.2g} at t = {:.6g}: f does "
      "not vanish at the ends of the velocity grid, or its fluxes are limited); give {}, or more "
      "velocity.points",
      of_energy ? "energy" : "momentum", share, at.t, larger_velocities(needed)));
}

/// Returns the remedy for velocities that end too early: the largest velocity that is needed. The grid may
/// already contain it if f is no Maxwellian; then the remedy is a larger grid.
std::string velocity_watch::larger_velocities(double needed) const {
  const double largest = support_->molecules().grid().max();
  constexpr double above_rounding = 1.01;  // allows for three printed digits
  return needed > above_rounding * largest ? fmt::format("velocity.max = {:.3g} or more", needed)
                                           : fmt::format("a velocity.max above {:.3g}", largest);
}

/// Returns the largest velocity that the gas needs now, and when its streams come to rest. They rest
/// relative to walls, or without walls relative to the mean velocity. Without walls, a force may also
/// accelerate the gas until the end.
double velocity_watch::velocity_that_would_do(const field& state, const step_record& at) const {
  field room;
  const field& u = on_host(state, room);
  const gas& molecules = support_->molecules();
  const auto d = static_cast<std::size_t>(molecules.dimensions());
  std::array<double, 3> rest{}, speed{};
  if (!has_walls(setup_.config())) {
    for (std::size_t k = 0; k < d; ++k) rest[k] = at.total[1 + k] / at.total[0];
    if (const auto of = make_acceleration(setup_.config(), *setup_.equation))
      for (std::size_t k = 0; k < d; ++k) speed[k] = of->largest[k] * (setup_.config().time.end - at.t);
  }
  double needed = 0.0;
  std::array<double, 5> omega{};
  for (int cell = 0; cell < u.cells(); ++cell) {
    if (setup_.mesh().solid(cell) >= 0) continue;
    molecules.moments(u.row(cell), 0, 1, omega.data());
    const fluid_state s = molecules.state(omega.data());
    if (!(s.rho >= least_density_) || !s.admissible()) continue;
    double square = 0.0;
    for (std::size_t k = 0; k < d; ++k) square += (s.u[k] - rest[k]) * (s.u[k] - rest[k]);
    for (std::size_t k = 0; k < d; ++k)
      needed = std::max({needed, velocity_needed(std::abs(s.u[k]) + speed[k], s.T),
                         velocity_needed(rest[k], s.T + square / molecules.degrees_of_freedom())});
  }
  std::array<double, 1> negative = {-needed};
  setup_.processes().lowest(negative);
  return -negative[0];
}

std::optional<worst_velocities> worst_of_all(communicator& processes, double missed, long number,
                                             const std::vector<double>& omega) {
  std::array<double, 1> most = {number < 0 ? unlimited : -missed};
  processes.lowest(most);
  std::array<double, 1> first = {number >= 0 && -missed == most[0] ? static_cast<double>(number) : unlimited};
  const double own = first[0];
  processes.lowest(first);
  if (first[0] == unlimited) return std::nullopt;
  worst_velocities found{static_cast<long>(first[0]), omega};
  if (own != first[0]) std::fill(found.omega.begin(), found.omega.end(), unlimited);
  processes.lowest(found.omega);
  return found;
}

}  // namespace apsis
