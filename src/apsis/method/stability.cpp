#include <apsis/method/stability.hpp>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace apsis {

std::complex<long double> stability_function(const butcher_form<long double>& b,
                                             std::complex<long double> z) {
  using complex = std::complex<long double>;
  const complex z2 = z * z;
  std::vector<complex> y(b.stages());
  for (std::size_t i = 0; i < y.size(); ++i) {
    complex sum(1);
    for (std::size_t j = 0; j < i; ++j) sum += (z * b.A(i, j) + z2 * b.A_dot(i, j)) * y[j];
    y[i] = sum / (complex(1) - z * b.A(i, i) - z2 * b.A_dot(i, i));
  }
  return y.back();
}

namespace {

constexpr int samples = 480;

/// Radii from 1e-4 to 1e8, evenly in the logarithm.
long double radius(int k) {
  return std::pow(10.0L, -4.0L + 12.0L * static_cast<long double>(k) / samples);
}

/// sup |R| on the ray at `degrees` from the negative axis.
long double largest_on_ray(const butcher_form<long double>& b, long double degrees) {
  const long double radians = degrees * std::numbers::pi_v<long double> / 180.0L;
  long double largest = 0;
  for (int k = 0; k <= samples; ++k) {
    const long double size = std::abs(
        stability_function(b, -radius(k) * std::complex<long double>(std::cos(radians), std::sin(radians))));
    if (!(size <= largest)) largest = size;
  }
  return largest;
}

/// Rounding, and the flat start |R| = 1 + O(z^{p+1}) near 0.
constexpr long double stable = 1.0L + 1e-10L;

/// The boundary between stable and unstable rays, by steps of 5 degrees and bisection: inside a sector
/// without poles |R| is largest on its boundary, so that one ray speaks for the sector.
double sector(const butcher_form<long double>& b) {
  constexpr long double stride = 5;
  long double inside = 0, outside = stride;
  while (outside <= 90 && largest_on_ray(b, outside) <= stable) {
    inside = outside;
    outside += stride;
  }
  if (outside > 90) return 90.0;
  for (int k = 0; k < 14; ++k) {
    const long double middle = (inside + outside) / 2;
    (largest_on_ray(b, middle) <= stable ? inside : outside) = middle;
  }
  return static_cast<double>(inside);
}

}  // namespace

implicit_stability analyse_stability(const butcher_form<long double>& b) {
  implicit_stability s;
  long double largest = 0, smallest = 1;
  for (int k = 0; k <= samples; ++k) {
    const long double value = stability_function(b, -radius(k)).real();
    largest = std::max(largest, std::abs(value));
    smallest = std::min(smallest, value);
  }
  s.largest_on_negative_axis = static_cast<double>(largest);
  s.smallest_on_negative_axis = static_cast<double>(smallest);
  s.at_infinity = static_cast<double>(std::abs(stability_function(b, -1e12L)));
  for (std::size_t i = 0; i < b.stages(); ++i)
    if (b.A(i, i) == 0 && b.A_dot(i, i) < 0)
      s.imaginary_poles.push_back(static_cast<double>(1 / std::sqrt(-b.A_dot(i, i))));
  s.angle = largest <= stable ? sector(b) : 0.0;
  constexpr double vanishing = 1e-9;  // R ~ 1/z at z = −1e12
  s.l_stable = s.angle == 90.0 && s.at_infinity <= vanishing;
  return s;
}

}  // namespace apsis
