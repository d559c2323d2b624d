#include <apsis/method/stability.hpp>

#include <apsis/method/golden_section.hpp>
#include <apsis/method/internal/complex_product.hpp>
#include <apsis/method/stable_ray.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace apsis {

std::complex<long double> stability_function(const butcher_form<long double>& b,
                                             std::complex<long double> z) {
  // Real arithmetic: std::complex products check for infinities, which would dominate the time
  // of a certificate.
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

using complex = std::complex<long double>;

/// R(z) from the nonzero entries of the Shu–Osher form. The families have O(s) of them, but O(s²) in the
/// Butcher form.
class sparse_function {
 public:
  explicit sparse_function(const shu_osher_form<long double>& m) {
    const auto initial = initial_weights(m);
    for (std::size_t i = 0; i < m.stages(); ++i) {
      row r{initial[i], m.D(i, i), m.ddot[i], {}, {}};
      for (std::size_t j = 0; j < i; ++j) {
        if (m.P(i, j) + m.W(i, j) != 0) r.mixed.push_back({j, m.P(i, j) + m.W(i, j)});
        if (m.D(i, j) != 0) r.coupled.push_back({j, m.D(i, j)});
      }
      rows_.push_back(std::move(r));
    }
  }

  complex operator()(complex z) const {
    const complex z2 = times(z, z);
    stages_.clear();
    for (const row& r : rows_) {
      complex stage = r.initial, coupled = 0;
      for (const auto& [j, weight] : r.mixed) stage += weight * stages_[j];
      for (const auto& [j, weight] : r.coupled) coupled += weight * stages_[j];
      if (!r.coupled.empty()) stage += times(z, coupled);
      if (r.d != 0 || r.ddot != 0) {
        const complex below = 1.0L - r.d * z - r.ddot * z2;
        stage = times(stage, std::conj(below)) / std::norm(below);
      }
      stages_.push_back(stage);
    }
    return stages_.back();
  }

 private:
  struct entry {
    std::size_t column;
    long double weight;
  };
  struct row {
    long double initial, d, ddot;
    std::vector<entry> mixed, coupled;
  };
  std::vector<row> rows_;
  mutable std::vector<complex> stages_;
};

constexpr int samples = 480;

/// Logarithmically spaced radii from 1e-4 to 1e8; k need not be an integer.
long double radius(long double k) {
  return std::pow(10.0L, -4.0L + 12.0L * k / samples);
}

const std::vector<long double>& sampled_radii() {
  static const std::vector<long double> radii = [] {
    std::vector<long double> all;
    for (int k = 0; k <= samples; ++k) all.push_back(radius(static_cast<long double>(k)));
    return all;
  }();
  return radii;
}

/// Returns the maximum of f(radius(k)): the largest sample, and golden-section maxima around all samples that
/// are not below their neighbours.
template <class Function>
long double maximum_over_radii(const Function& f) {
  std::vector<long double> values;
  for (const long double r : sampled_radii()) values.push_back(f(r));
  long double largest = *std::max_element(values.begin(), values.end());
  for (std::size_t k = 1; k + 1 < values.size(); ++k) {
    if (!(values[k] >= values[k - 1] && values[k] >= values[k + 1])) continue;
    constexpr int steps = 40;  // 0.618⁴⁰ = 4·10⁻⁹ of the bracket, sufficient because maxima are flat
    const auto place = static_cast<long double>(k);
    largest = std::max(
        largest,
        golden_section([&](long double x) { return f(radius(x)); }, place - 1, place + 1, steps).value);
  }
  return largest;
}

complex direction(long double degrees) {
  const long double radians = degrees * std::numbers::pi_v<long double> / 180.0L;
  return {-std::cos(radians), -std::sin(radians)};
}

/// Allowance for rounding and for |R| = 1 + O(z^{p+1}) near 0.
constexpr long double stable = 1.0L + 1e-10L;

/// Whether |R| ≤ 1 at all samples of the ray at angle `degrees` from the negative axis.
bool seems_stable(const sparse_function& R, long double degrees) {
  const auto u = direction(degrees);
  const auto size = [&](long double r) {
    const long double value = std::sqrt(std::norm(R(r * u)));
    return std::isnan(value) ? std::numeric_limits<long double>::infinity() : value;
  };
  return maximum_over_radii(size) <= stable;
}

/// Returns the angle in degrees between the negative axis and the closest pole 1 − zd − z²ḋ = 0 of a stage in
/// Re z < 0; 90 if there is none, which d ≥ 0 ≥ ḋ guarantees.
long double angle_of_poles(const shu_osher_form<long double>& m) {
  long double angle = 90;
  const auto pole = [&angle](std::complex<long double> z) {
    if (z.real() >= 0) return;
    angle = std::min(angle, std::abs(std::arg(-z)) * 180.0L / std::numbers::pi_v<long double>);
  };
  for (std::size_t i = 0; i < m.stages(); ++i) {
    const long double d = m.D(i, i), ddot = m.ddot[i];
    if (d >= 0 && ddot <= 0) continue;
    if (ddot == 0) {
      pole(1 / d);
      continue;
    }
    const auto root = std::sqrt(std::complex<long double>(d * d + 4 * ddot));
    pole((-d + root) / (2 * ddot));
    pole((-d - root) / (2 * ddot));
  }
  return angle;
}

/// Returns the angle of A(α)-stability: found in steps of 5 degrees and by bisection, then rounded down
/// until it is proved. Inside a sector without poles |R| attains its maximum on the boundary, so that
/// one ray suffices.
double sector(const shu_osher_form<long double>& m, const sparse_function& R) {
  constexpr long double stride = 5, unit = 1e-4L;
  const long double most = angle_of_poles(m);
  long double inside = 0, outside = stride;
  while (outside <= 90 && seems_stable(R, outside)) {
    inside = outside;
    outside += stride;
  }
  if (outside > 90 && most == 90 && is_stable_imaginary_axis(m)) return 90.0;
  outside = std::min(outside, 90.0L);
  while (outside - inside > unit / 8) {
    const long double middle = (inside + outside) / 2;
    (seems_stable(R, middle) ? inside : outside) = middle;
  }
  const auto units = static_cast<long>(std::floor(std::min(inside, most) / unit));
  for (long less = 0; less < units; less = 2 * less + 1) {
    const auto angle = static_cast<double>(static_cast<long double>(units - less) * unit);
    if (angle < most && is_stable_ray(m, angle)) return angle;
  }
  return 0.0;
}

/// Returns the implicit part alone. If the Q weights of an update repeat those of an earlier stage, the
/// update is identified with that stage. This occurs in methods with b = e_s·A whose b̂ differs.
shu_osher_form<long double> implicit_part(const shu_osher_form<long double>& m) {
  const auto b = to_butcher(m);
  const std::size_t last = m.stages() - 1;
  const auto repeats = [&](std::size_t i) {
    constexpr long double rounding = 1e-17L;
    for (std::size_t j = 0; j <= last; ++j)
      if (std::abs(b.A(i, j) - b.A(last, j)) > rounding ||
          std::abs(b.A_dot(i, j) - b.A_dot(last, j)) > rounding)
        return false;
    return true;
  };
  std::size_t stages = 1;
  while (stages <= last && !repeats(stages - 1)) ++stages;
  const auto corner = [stages](const matrix<long double>& whole) {
    matrix<long double> part(stages, stages);
    for (std::size_t i = 0; i < stages; ++i)
      for (std::size_t j = 0; j < stages; ++j) part(i, j) = whole(i, j);
    return part;
  };
  shu_osher_form<long double> part{corner(m.P), corner(m.W), corner(m.D), m.ddot, m.r};
  part.ddot.resize(stages);
  return part;
}

}  // namespace

implicit_stability analyse_stability(const shu_osher_form<long double>& method) {
  const auto m = implicit_part(method);
  implicit_stability s;
  const sparse_function R(m);
  const auto on_axis = [&R](long double r) { return R(-r).real(); };
  const long double smallest = -maximum_over_radii([&](long double r) { return -on_axis(r); });
  // sup |R(x)| is at least its limit 1 for x → 0.
  s.largest_on_negative_axis = static_cast<double>(
      std::max(1.0L, maximum_over_radii([&](long double r) { return std::abs(on_axis(r)); })));
  s.smallest_on_negative_axis = static_cast<double>(smallest);
  constexpr long double far = 1e12L, vanishing = 1e-9L;  // R ~ 1/z or less there, if it tends to 0
  const long double limit = std::abs(on_axis(far));
  s.at_infinity = limit <= vanishing ? 0.0 : static_cast<double>(limit);
  for (std::size_t i = 0; i < m.stages(); ++i)
    if (m.D(i, i) == 0 && m.ddot[i] < 0)
      s.imaginary_poles.push_back(static_cast<double>(1 / std::sqrt(-m.ddot[i])));
  s.angle = s.largest_on_negative_axis <= static_cast<double>(stable) ? sector(m, R) : 0.0;
  s.l_stable = s.angle == 90.0 && s.at_infinity == 0.0;
  return s;
}

}  // namespace apsis
