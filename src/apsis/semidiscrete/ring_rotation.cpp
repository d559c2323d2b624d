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

/// Returns the sine of the angle of an edge 0 … M/2. Symmetry gives all other sines and cosines, so that
/// symmetric rows stay symmetric to the last bit.
double sine(int edge, int angles) {
  return std::sin(std::min(edge, angles / 2 - edge) * (2.0 * std::numbers::pi / angles));
}

}  // namespace

/// Buffers of one thread.
struct ring_rotation::workspace {
  std::array<aligned_vector<double>, 4> places;  ///< memory of rotation_rows::places
  aligned_vector<double> values;                 ///< a ring with its halo
  aligned_vector<double> change;                 ///< change of the row of a cell
};

ring_rotation::~ring_rotation() = default;
ring_rotation::ring_rotation(ring_rotation&&) noexcept = default;

ring_rotation::ring_rotation(const model& equation, std::shared_ptr<domain> space, int radial,
                             const limited_reconstruction& edges)
    : equation_(equation),
      space_(std::move(space)),
      layout_(equation.polar()),
      radial_(radial),
      limited_(edges.keeps_sign()),
      fifth_order_(edges.scheme->order() > 1),
      smallest_radius_(smallest_radius()),
      at_edge_(limited_ ? 1.0 + 0.5 * space_->mesh().spacing(radial) / smallest_radius_ : 1.0),
      invariants_(equation.invariants().size()),
      workspaces_(std::make_unique<per_thread<workspace>>()) {
  if (layout_.empty())
    throw input_error(
        "the flow cannot be axisymmetric (the velocities of the model have no rings around the axis); choose "
        "polar velocities");
  if (const int least = fifth_order_ ? least_angles : 4; layout_.angles < least || layout_.angles % 4 != 0)
    throw input_error(fmt::format(
        "{} angles of velocities (images at the axis need a multiple of 4, and differences in the "
        "angle are stable from {} on); give {} or more",
        layout_.angles, least, least));
  if (!(smallest_radius_ > 0.0))
    throw input_error(fmt::format(
        "the centre of a cell has r = {:g} (the distance from the axis must be positive); begin the mesh at "
        "r >= 0",
        smallest_radius_));
  of_cells_.resize(static_cast<std::size_t>(space_->mesh().size()) * invariants_);
  given_.resize(invariants_);
  find_speeds();
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

void ring_rotation::find_speeds() {
  const int angles = layout_.angles;
  const auto apart = static_cast<std::size_t>(layout_.apart);
  const double width = 2.0 * std::numbers::pi / angles;
  stretch_ = 0.5 * width / std::sin(0.5 * width);
  for (int edge = 0; edge <= angles; ++edge) {
    const int folded = edge % (angles / 2), cosine = (edge + angles / 4) % angles;
    const double sign = cosine < angles / 2 ? 1.0 : -1.0;
    speeds_.insert(speeds_.end(), apart, stretch_ * sine(folded, angles));
    slopes_.insert(slopes_.end(), apart, sign * width * sine(cosine % (angles / 2), angles));
  }
  const std::size_t of_ring = size_of_ring();
  for (std::size_t k = 0; k < static_cast<std::size_t>(equation_.components()); ++k) {
    const std::size_t number = k % of_ring;
    const double below = speeds_[number], above = speeds_[number + apart];
    per_speed_.push_back(width * smallest_radius_ / speed_of(k / of_ring));
    rates_.push_back((2 * number < of_ring ? below : above) / per_speed_.back());
    largest_.push_back(std::max(below, above) / per_speed_.back());
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

void ring_rotation::prepare(const field& u) const {
  const rotation_rows::ring ring{layout_.angles, layout_.apart};
  workspaces_->prepare([&](workspace& here) {
    for (auto& places : here.places) places.resize(ring.places());
    here.values.resize(ring.continued());
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
  const rotation_rows::ring ring{layout_.angles, layout_.apart};
  const rotation_rows::places places{here.places[0].data(), here.places[1].data(), here.places[2].data(),
                                     here.places[3].data()};
  const double width = 2.0 * std::numbers::pi / layout_.angles;
  rotation_rows::flux_rule rule{.fifth_order = fifth_order_,
                                .limited = limited_,
                                .speeds = speeds_.data(),
                                .slopes = slopes_.data(),
                                .first = 1.0 / 12.0 + 7.0 / 1440.0 * width * width,
                                .third = -1.0 / 120.0,
                                .second = -width * width / (180.0 * stretch_),
                                .inverse = nullptr,
                                .scale = r / smallest_radius_};
  for (std::size_t first = 0; first < rates_.size(); first += size_of_ring()) {
    rule.inverse = inverse_.data() + first;
    rotation_rows::continue_ring(ring, u.row(cell) + first, here.values.data());
    rotation_rows::turn(ring, rule, here.values.data(), speed_of(first / size_of_ring()) / (r * width),
                        places, here.change.data() + first);
  }
  equation_.invariant_densities(here.change.data(),
                                of_cells_.data() + static_cast<std::size_t>(cell) * invariants_);
  for (const auto& to : targets)
    lattice_rows::add(here.change.data(), to.beta, u.components(), to.acc->row(cell));
}

}  // namespace apsis
