#include <apsis/model/line_family.hpp>

#include <apsis/model/line_sums.hpp>
#include <apsis/model/vector_math.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace apsis {

void line_family::attach(const velocity_line& line, bool weighted, int nearest_point, double offset,
                         face at) {
  const int n = line.points();
  if (n != n_) {
    n_ = n;
    padded_ = (n + packet_length - 1) / packet_length * packet_length;
    for (auto* one : {&x_, &c_, &base_, &weights_, &values_})
      one->assign(static_cast<std::size_t>(padded_), 0.0);
  }
  line_ = &line;
  weighted_ = weighted;
  if (weighted) std::copy(line.weights().begin(), line.weights().end(), base_.begin());
  const double* place = line.places().data();
  const bool nearest = at == face::nearest;
  // The neighbour on the side of the mean; either neighbour if the mean is a grid point.
  const int other = nearest_point + ((offset > 0.0 || nearest_point == 0) ? 1 : -1);
  nearest_ = nearest_point;
  left_ = nearest ? std::min(nearest_point, other) : 0;
  right_ = nearest ? std::max(nearest_point, other) : n - 1;
  const double here = place[nearest_point], before = here - place[left_], after = place[right_] - here;
  offset_ = offset;
  ends_ = after - before;
  mean_ = before + offset;
  from_right_ = after - offset;
  fixed_ = offset == 0.0 && (nearest_point == 0 || nearest_point == n - 1);
  double *x = x_.data(), *c = c_.data();
  sign_ = nearest ? 1.0 : -1.0;
  const double sign = sign_, left = place[left_], right = place[right_];
#pragma omp simd
  for (int j = 0; j < n; ++j) {
    x[j] = (place[j] - here) - offset;
    c[j] = sign * (place[j] - left) * (place[j] - right);
  }
}

double line_family::largest_exponent(double beta, double tau) const {
  const auto exponent = [&](int j) {
    return beta * x_[static_cast<std::size_t>(j)] - tau * c_[static_cast<std::size_t>(j)];
  };
  double largest = std::max(exponent(0), exponent(n_ - 1));
  for (int j = 1; tau * sign_ > 0.0 && j + 1 < n_; ++j) largest = std::max(largest, exponent(j));
  return largest;
}

line_family::sums line_family::evaluate(double beta, double tau) {
  if (fixed_) {
    sums s;
    s.mass = take_limit();
    return s;
  }
  // The point nearest to the mean has about the largest weight, unless the parameters are far off.
  constexpr double large = 1e90;  // the product of three directions is finite
  if (sign_ > 0.0) {
    const sums s = sums_of(beta, tau, beta * x_[static_cast<std::size_t>(nearest_)]);
    if (s.mass < large) return s;
  }
  return sums_of(beta, tau, largest_exponent(beta, tau));
}

line_family::sums line_family::sums_of(double beta, double tau, double shift) {
  const double* base = weighted_ ? base_.data() : nullptr;
  const auto of = line_sums::weigh(x_.data(), c_.data(), base, n_, beta, tau, shift, weights_.data());
  return {of.mass, of.above, of.below, of.energy / of.mass};
}

line_family::slopes line_family::differentiate(const sums& s) const {
  if (fixed_) return {};
  const auto of = line_sums::multiply(x_.data(), c_.data(), weights_.data(), n_);
  const double per_above = 1.0 / s.above, per_below = 1.0 / s.below, per_mass = 1.0 / s.mass;
  slopes by;
  by.imbalance_by_beta = of.above_x * per_above - of.below_x * per_below;
  by.imbalance_by_tau = of.below_c * per_below - of.above_c * per_above;
  by.energy_by_beta = (of.above_c - of.below_c) * per_mass - s.energy * ((s.above - s.below) * per_mass);
  by.energy_by_tau = s.energy * s.energy - of.cc * per_mass;
  return by;
}

line_family::sums line_family::solve(double tau, double& beta) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double lowest = -infinity, highest = infinity, stride = 1.0;
  newton_end end;
  sums s = evaluate(beta, tau);
  if (fixed_) return s;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const double h = s.imbalance();  // ±∞ where all weights of one side underflow
    const bool slow = !(std::abs(h) < 0.5 * end.previous());
    if (end.reached(std::abs(h))) break;
    (h < 0.0 ? lowest : highest) = beta;
    const bool enclosed = std::isfinite(lowest) && std::isfinite(highest);
    // The slope is infinite if all weights of one side are nearly subnormal. Only the sign is then known.
    const double slope = differentiate(s).imbalance_by_beta;
    double next = std::isfinite(slope) ? beta - h / slope : std::numeric_limits<double>::quiet_NaN();
    if (next == beta) break;
    if (!(next > lowest && next < highest) || (slow && enclosed)) {
      if (end.close()) break;
      if (enclosed) {
        next = 0.5 * (lowest + highest);
      } else {
        next = beta + (h < 0.0 ? stride : -stride);
        stride *= 2.0;
      }
    }
    if (next == lowest || next == highest) break;  // adjacent numbers
    beta = next;
    s = evaluate(beta, tau);
  }
  return s;
}

double line_family::take_limit() {
  std::fill(weights_.begin(), weights_.end(), 0.0);
  const auto left = static_cast<std::size_t>(left_), right = static_cast<std::size_t>(right_);
  const double gap = line_->places()[right] - line_->places()[left];
  weights_[left] = from_right_ / gap;
  weights_[right] = mean_ / gap;
  return 1.0;
}

const double* line_family::values() {
  if (!weighted_) return weights_.data();
  for (std::size_t j = 0; j < static_cast<std::size_t>(n_); ++j) values_[j] = weights_[j] / base_[j];
  return values_.data();
}

}  // namespace apsis
