#include <apsis/method/stability.hpp>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace apsis {

std::complex<long double> stability_function(const butcher_form<long double>& b,
                                             std::complex<long double> z) {
  // Written out: products of complex numbers that look for infinities take most of the time of a certificate.
  using complex = std::complex<long double>;
  const long double x = z.real(), y = z.imag(), x2 = x * x - y * y, y2 = 2 * x * y;
  std::vector<complex> stages(b.stages());
  for (std::size_t i = 0; i < stages.size(); ++i) {
    long double real = 1, imaginary = 0;
    for (std::size_t j = 0; j < i; ++j) {
      const long double a = b.A(i, j), derivative = b.A_dot(i, j);
      if (a == 0 && derivative == 0) continue;
      const long double weight = x * a + x2 * derivative, turn = y * a + y2 * derivative;
      real += weight * stages[j].real() - turn * stages[j].imag();
      imaginary += weight * stages[j].imag() + turn * stages[j].real();
    }
    const long double a = b.A(i, i), derivative = b.A_dot(i, i);
    stages[i] = complex(real, imaginary) / complex(1 - x * a - x2 * derivative, -y * a - y2 * derivative);
  }
  return stages.back();
}

namespace {

constexpr int samples = 480;

/// Radii from 1e-4 to 1e8, evenly in the logarithm.
long double radius(int k) {
  return std::pow(10.0L, -4.0L + 12.0L * static_cast<long double>(k) / samples);
}

/// Rounding, and the flat start |R| = 1 + O(z^{p+1}) near 0.
constexpr long double stable = 1.0L + 1e-10L;

/// Whether |R| ≤ 1 on the ray at `degrees` from the negative axis.
bool is_stable_ray(const butcher_form<long double>& b, long double degrees) {
  const long double radians = degrees * std::numbers::pi_v<long double> / 180.0L;
  const std::complex<long double> direction(-std::cos(radians), -std::sin(radians));
  for (int k = 0; k <= samples; ++k)
    if (!(std::abs(stability_function(b, radius(k) * direction)) <= stable)) return false;
  return true;
}

/// The boundary between stable and unstable rays, by steps of 5 degrees and bisection: inside a sector
/// without poles |R| is largest on its boundary, so that one ray speaks for the sector.
double sector(const butcher_form<long double>& b) {
  constexpr long double stride = 5;
  long double inside = 0, outside = stride;
  while (outside <= 90 && is_stable_ray(b, outside)) {
    inside = outside;
    outside += stride;
  }
  if (outside > 90) return 90.0;
  for (int k = 0; k < 14; ++k) {
    const long double middle = (inside + outside) / 2;
    (is_stable_ray(b, middle) ? inside : outside) = middle;
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
