#include <paper/fourier_solution.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/extremes.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace apsis::paper {

using std::numbers::pi;

fourier_solution::fourier_solution(const limit_equations& system, double a, double b, int points,
                                   const std::function<void(double, std::span<double>)>& initial, double end,
                                   int steps)
    : system_(system), a_(a), length_(b - a), points_(system.flux ? points : 1), unknowns_(system.unknowns) {
  if (points_ % 2 == 0)
    throw input_error(
        "an even number of collocation points (the highest mode would have no derivative); give an odd one");
  derivative_.assign(static_cast<std::size_t>(points_), 0.0);
  for (int d = 1; d < points_; ++d)
    derivative_[static_cast<std::size_t>(d)] =
        pi / length_ * (d % 2 == 0 ? 1.0 : -1.0) / std::sin(d * pi / points_);

  std::vector<double> omega(at(points_, 0)), stage(omega.size()), k(omega.size()), sum(omega.size());
  const auto width = static_cast<std::size_t>(unknowns_);
  for (int j = 0; j < points_; ++j)
    initial(a_ + length_ * j / points_, std::span(omega).subspan(at(j, 0), width));
  const double dt = end / steps;
  constexpr double weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0}, ahead[4] = {0.0, 0.5, 0.5, 1.0};
  for (int n = 0; n < steps; ++n) {
    sum = omega;
    for (int s = 0; s < 4; ++s) {
      for (std::size_t i = 0; i < omega.size(); ++i)
        stage[i] = omega[i] + (s > 0 ? ahead[s] * dt * k[i] : 0.0);
      slope(stage, k);
      for (std::size_t i = 0; i < omega.size(); ++i) sum[i] += weight[s] * dt * k[i];
    }
    std::swap(omega, sum);
  }
  transform(omega);
}

void fourier_solution::slope(const std::vector<double>& omega, std::vector<double>& change) const {
  std::fill(change.begin(), change.end(), 0.0);
  if (system_.source)
    for (int j = 0; j < points_; ++j) system_.source(omega.data() + at(j, 0), change.data() + at(j, 0));
  if (!system_.flux) return;
  std::vector<double> flux(omega.size());
  for (int j = 0; j < points_; ++j) system_.flux(omega.data() + at(j, 0), flux.data() + at(j, 0));
  for (int j = 0; j < points_; ++j)
    for (int l = 0; l < points_; ++l) {
      const int d = j - l;
      const double weight =
          d >= 0 ? derivative_[static_cast<std::size_t>(d)] : -derivative_[static_cast<std::size_t>(-d)];
      for (int k = 0; k < unknowns_; ++k) change[at(j, k)] -= weight * flux[at(l, k)];
    }
}

void fourier_solution::transform(const std::vector<double>& omega) {
  const int modes = points_ / 2 + 1;
  cosine_.assign(at(modes, 0), 0.0);
  sine_.assign(at(modes, 0), 0.0);
  for (int m = 0; m < modes; ++m)
    for (int j = 0; j < points_; ++j)
      for (int k = 0; k < unknowns_; ++k) {
        const double angle = 2.0 * pi * ((m * j) % points_) / points_, scale = (m == 0 ? 1.0 : 2.0) / points_;
        cosine_[at(m, k)] += scale * std::cos(angle) * omega[at(j, k)];
        sine_[at(m, k)] += scale * std::sin(angle) * omega[at(j, k)];
      }
}

double fourier_solution::average(int k, double x, double h) const {
  double sum = 0.0;
  for (int m = points_ / 2; m >= 0; --m) {
    const double wave = 2.0 * pi * m / length_, half = 0.5 * wave * h;
    const double shrink = half > 0.0 ? std::sin(half) / half : 1.0;
    sum += shrink *
           (cosine_[at(m, k)] * std::cos(wave * (x - a_)) + sine_[at(m, k)] * std::sin(wave * (x - a_)));
  }
  return sum;
}

double fourier_solution::resolution() const {
  const auto size = [this](int m) {
    double largest = 0.0;
    for (int k = 0; k < unknowns_; ++k)
      largest = maximum(largest, std::hypot(cosine_[at(m, k)], sine_[at(m, k)]));
    return largest;
  };
  double largest = 0.0, highest = 0.0;
  for (int m = 0; m <= points_ / 2; ++m) {
    largest = maximum(largest, size(m));
    if (m > 0 && m >= points_ / 2 - 1) highest = maximum(highest, size(m));
  }
  return highest / largest;
}

}  // namespace apsis::paper
