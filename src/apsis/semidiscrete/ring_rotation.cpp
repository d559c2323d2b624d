#include <apsis/semidiscrete/ring_rotation.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/scheme/limiter.hpp>
#include <apsis/semidiscrete/lattice_rows.hpp>
#include <apsis/semidiscrete/rotation_rows.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

constexpr int least_angles = 12;  // for fifth order: with 8 angles, waves between walls grow

/// Returns the rings of the velocities. Throws input_error if there are none, or too few angles.
polar_layout checked_layout(const model& equation, const limited_reconstruction& edges) {
  polar_layout layout = equation.polar();
  if (layout.empty())
    throw input_error(
        "the flow cannot be axisymmetric (the velocities of the model have no rings around the axis); choose "
        "polar velocities");
  if (const int least = edges.scheme->order() > 1 ? least_angles : 4;
      layout.angles < least || layout.angles % 4 != 0)
    throw input_error(fmt::format(
        "{} angles of velocities (images at the axis need a multiple of 4, and differences in the "
        "angle are stable from {} on); give {} or more",
        layout.angles, least, least));
  return layout;
}

}  // namespace

/// Buffers of one thread.
struct ring_rotation::workspace {
  ring_turn::workspace turn;
  aligned_vector<double> change;  ///< change of the row of a cell
};

ring_rotation::~ring_rotation() = default;
ring_rotation::ring_rotation(ring_rotation&&) noexcept = default;

ring_rotation::ring_rotation(const model& equation, std::shared_ptr<domain> space, int radial,
                             const limited_reconstruction& edges)
    : equation_(equation),
      space_(std::move(space)),
      turn_(checked_layout(equation, edges), edges.scheme->order() > 1),
      radial_(radial),
      limited_(edges.keeps_sign()),
      smallest_radius_(smallest_radius()),
      at_edge_(limited_ ? 1.0 + 0.5 * space_->mesh().spacing(radial) / smallest_radius_ : 1.0),
      invariants_(equation.invariants().size()),
      workspaces_(std::make_unique<per_thread<workspace>>()) {
  if (!(smallest_radius_ > 0.0))
    throw input_error(fmt::format(
        "the centre of a cell has r = {:g} (the distance from the axis must be positive); begin the mesh at "
        "r >= 0",
        smallest_radius_));
  of_cells_.resize(static_cast<std::size_t>(space_->mesh().size()) * invariants_);
  given_.resize(invariants_);
  find_rates();
}

/// Returns the smallest radius of all processes, since all take the same steps.
double ring_rotation::smallest_radius() const {
  const grid& whole = space_->shared_mesh() != nullptr ? space_->shared_mesh()->whole : space_->mesh();
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& [begin, end] : whole.fluid())
    for (int cell = begin; cell < end; ++cell)
      smallest = std::min(smallest, whole.centre(cell)[static_cast<std::size_t>(radial_)]);
  return smallest;
}

void ring_rotation::find_rates() {
  for (std::size_t k = 0; k < static_cast<std::size_t>(equation_.components()); ++k) {
    const double out = turn_.outflow(k);
    per_speed_.push_back(turn_.width() * smallest_radius_ / turn_.speed_of(k / turn_.size_of_ring()));
    rates_.push_back(out / per_speed_.back());
    largest_.push_back(std::max(out, turn_.inflow(k)) / per_speed_.back());
  }
  inverse_.resize(rates_.size());
  left_.resize(rates_.size());
}

aligned_vector<double> ring_rotation::rates_through_cells(const std::vector<line_speeds>& speeds) const {
  aligned_vector<double> rates(speeds.front().per_cell.size());
  for (std::size_t d = 0; d < speeds.size(); ++d)
    for (std::size_t k = 0; k < rates.size(); ++k)
      rates[k] += factor_of(speeds[d], d, k) * speeds[d].per_cell[k];
  return rates;
}

aligned_vector<double> ring_rotation::rates_with(const std::vector<line_speeds>& speeds) const {
  auto rates = rates_through_cells(speeds);
  for (std::size_t k = 0; k < rates.size(); ++k)
    if (const std::size_t j = k % stride(); j < rates_.size()) rates[k] += rates_[j];
  return rates;
}

void ring_rotation::limit_for_steps(double step, std::vector<line_speeds>& speeds) {
  steady_ = false;
  const auto through_cells = rates_through_cells(speeds), all = rates_with(speeds);
  const double fastest = *std::max_element(all.begin(), all.end());
  for (auto& line : speeds) line.inverse_cfl.resize(all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::size_t j = k % stride();
    const double of_rotation =
        j < rates_.size() ? std::max(rates_[j], std::min(largest_[j], fastest - through_cells[k])) : 0.0;
    const double x = step * (through_cells[k] + of_rotation);
    const double cfl_of_rotation = std::max(limiter::least_cfl_number, std::sqrt(x)),
                 left = 1.0 - step * of_rotation / cfl_of_rotation;
    for (std::size_t d = 0; d < speeds.size(); ++d)
      speeds[d].inverse_cfl[k] =
          1.0 /
          std::max(limiter::least_cfl_number, step * through_cells[k] / (left * factor_of(speeds[d], d, k)));
    if (k >= rates_.size()) continue;
    inverse_[k] = of_rotation * per_speed_[k] / cfl_of_rotation;
    left_[k] = left;
  }
}

void ring_rotation::limit_for_steady_states(double collisions, std::vector<line_speeds>& speeds) {
  steady_ = true;
  const auto all = rates_with(speeds);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double inverse_cfl = limiter::steady_inverse_cfl(all[k], collisions);
    for (std::size_t d = 0; d < speeds.size(); ++d)
      speeds[d].inverse_cfl[k] = inverse_cfl * factor_of(speeds[d], d, k);
    if (k < rates_.size()) inverse_[k] = inverse_cfl * largest_[k] * per_speed_[k];
  }
}

void ring_rotation::prepare(const field& u) const {
  workspaces_->prepare([&](workspace& here) {
    here.turn = turn_.make_workspace();
    here.change.resize(static_cast<std::size_t>(u.stride()));
  });
}

void ring_rotation::add(const field& u, std::span<const target<field, double>> targets, int begin,
                        int end) const {
  const profile::section timed(kernel::forces, static_cast<double>(end - begin) * u.stride(),
                               traffic(targets));
  for (int cell = begin; cell < end; ++cell) add_cell(u, targets, cell, workspaces_->here());
}

void ring_rotation::add_cell(const field& u, std::span<const target<field, double>> targets, int cell,
                             workspace& here) const {
  const double r = space_->mesh().centre(cell)[static_cast<std::size_t>(radial_)];
  rotation_rows::flux_rule rule = turn_.rule();
  rule.limited = limited_;
  rule.scale = steady_ ? 1.0 : r / smallest_radius_;
  for (std::size_t ring = 0; ring * turn_.size_of_ring() < rates_.size(); ++ring) {
    rule.inverse = inverse_.data() + ring * turn_.size_of_ring();
    turn_.apply_to_ring(u.row(cell), ring, r, rule, here.turn, here.change.data());
  }
  equation_.invariant_densities(here.change.data(),
                                of_cells_.data() + static_cast<std::size_t>(cell) * invariants_);
  for (const auto& to : targets)
    lattice_rows::add(here.change.data(), to.beta, u.components(), to.acc->row(cell));
}

}  // namespace apsis
