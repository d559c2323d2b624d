#include <apsis/semidiscrete/ring_turn.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace apsis {
namespace {

/// Returns the sine of the angle of an edge 0 … M/2. Symmetry gives all other sines and cosines, so that
/// symmetric rows stay symmetric to the last bit.
double sine(int edge, int angles) {
  return std::sin(std::min(edge, angles / 2 - edge) * (2.0 * std::numbers::pi / angles));
}

}  // namespace

ring_turn::ring_turn(polar_layout layout, bool fifth_order)
    : layout_(std::move(layout)),
      fifth_order_(fifth_order),
      stretch_(0.5 * width() / std::sin(0.5 * width())) {
  const int angles = layout_.angles;
  const auto apart = static_cast<std::size_t>(layout_.apart);
  for (int edge = 0; edge <= angles; ++edge) {
    const int folded = edge % (angles / 2), cosine = (edge + angles / 4) % angles;
    const double sign = cosine < angles / 2 ? 1.0 : -1.0;
    speeds_.insert(speeds_.end(), apart, stretch_ * sine(folded, angles));
    slopes_.insert(slopes_.end(), apart, sign * width() * sine(cosine % (angles / 2), angles));
  }
}

double ring_turn::width() const {
  return 2.0 * std::numbers::pi / layout_.angles;
}

double ring_turn::outflow(std::size_t k) const {
  const std::size_t below = k % size_of_ring();
  return speeds_[in_upper_half(k) ? below : below + static_cast<std::size_t>(layout_.apart)];
}

double ring_turn::inflow(std::size_t k) const {
  const std::size_t below = k % size_of_ring();
  return speeds_[in_upper_half(k) ? below + static_cast<std::size_t>(layout_.apart) : below];
}

int ring_turn::upstream(std::size_t k) const {
  return in_upper_half(k) ? layout_.apart : -layout_.apart;
}

ring_turn::workspace ring_turn::make_workspace() const {
  const rotation_rows::ring ring{layout_.angles, layout_.apart};
  workspace here;
  for (auto& places : here.places) places.resize(ring.places());
  here.values.resize(ring.continued());
  return here;
}

rotation_rows::flux_rule ring_turn::rule() const {
  return {.fifth_order = fifth_order_,
          .limited = false,
          .speeds = speeds_.data(),
          .slopes = slopes_.data(),
          .first = 1.0 / 12.0 + 7.0 / 1440.0 * width() * width(),
          .third = -1.0 / 120.0,
          .second = -width() * width() / (180.0 * stretch_),
          .inverse = nullptr,
          .scale = 1.0};
}

void ring_turn::apply_to_ring(const double* row, std::size_t ring, double radius,
                              const rotation_rows::flux_rule& rule, workspace& here, double* change) const {
  const rotation_rows::ring of{layout_.angles, layout_.apart};
  const rotation_rows::places places{here.places[0].data(), here.places[1].data(), here.places[2].data(),
                                     here.places[3].data()};
  const std::size_t first = ring * size_of_ring();
  rotation_rows::continue_ring(of, row + first, here.values.data());
  rotation_rows::turn(of, rule, here.values.data(), speed_of(ring) / (radius * width()), places,
                      change + first);
}

void ring_turn::apply(const double* row, std::size_t components, double radius, workspace& here,
                      double* change) const {
  const rotation_rows::flux_rule unlimited = rule();
  for (std::size_t ring = 0; ring * size_of_ring() < components; ++ring)
    apply_to_ring(row, ring, radius, unlimited, here, change);
}

}  // namespace apsis
