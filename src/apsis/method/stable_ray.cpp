#include <apsis/method/stable_ray.hpp>

#include <apsis/method/internal/complex_product.hpp>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace apsis {
namespace {

using real = long double;
using complex = std::complex<real>;

/// |a|, provided that its square neither overflows nor underflows.
real modulus(complex a) {
  return std::sqrt(std::norm(a));
}

/// All complex numbers within `radius` of `middle`.
struct disc {
  complex middle;
  real radius = 0;
};

disc operator+(const disc& a, const disc& b) {
  return {a.middle + b.middle, a.radius + b.radius};
}

disc operator*(real a, const disc& b) {
  return {a * b.middle, std::abs(a) * b.radius};
}

disc operator*(const disc& a, const disc& b) {
  return {times(a.middle, b.middle),
          modulus(a.middle) * b.radius + modulus(b.middle) * a.radius + a.radius * b.radius};
}

/// Image of a disc under 1/z: a disc, of infinite radius if the argument contains 0.
disc inverse(const disc& a) {
  const real power = std::norm(a.middle) - a.radius * a.radius;
  if (!(power > 0)) return {0, std::numeric_limits<real>::infinity()};
  return {std::conj(a.middle) / power, a.radius / power};
}

/// Enclosures of a function of t and of its derivative on an interval.
struct enclosure {
  disc value, slope;
};

enclosure operator+(const enclosure& a, const enclosure& b) {
  return {a.value + b.value, a.slope + b.slope};
}

enclosure operator*(real a, const enclosure& b) {
  return {a * b.value, a * b.slope};
}

enclosure operator*(const enclosure& a, const enclosure& b) {
  return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}

enclosure inverse(const enclosure& a) {
  const disc one_over = inverse(a.value);
  return {one_over, real(-1) * (a.slope * (one_over * one_over))};
}

enclosure constant(complex value) {
  return {{value, 0}, {0, 0}};
}

/// c₀ + c₁t + c₂t² for |t − middle| ≤ half.
enclosure quadratic(complex c0, complex c1, complex c2, real middle, real half) {
  const complex slope = c1 + 2 * middle * c2;
  return {{c0 + middle * (c1 + middle * c2), half * modulus(slope) + half * half * modulus(c2)},
          {slope, 2 * half * modulus(c2)}};
}

/// R on the ray as a function of t = |z| or t = 1/|z|, by forward substitution in the Shu–Osher form. Its
/// convex combinations do not cancel, so that the discs stay small.
class ray {
 public:
  ray(const shu_osher_form<real>& m, complex direction) : m_(m), direction_(direction) {
    initial_ = initial_weights(m);
    for (std::size_t i = 0; i < m.stages(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        if (m.P(i, j) + m.W(i, j) != 0) mixed_.push_back({i, j, m.P(i, j) + m.W(i, j)});
        if (m.D(i, j) == 0) continue;
        coupled_.push_back({i, j, m.D(i, j)});
        has_update_ = has_update_ || !is_implicit(i);
      }
  }

  /// R for |t − middle| ≤ half, z = t·direction, or direction/t if `far`.
  enclosure operator()(real middle, real half, bool far) {
    values_.clear();
    collisions_.clear();
    auto mixed = mixed_.begin();
    auto coupled = coupled_.begin();
    for (std::size_t i = 0; i < m_.stages(); ++i) {
      source from = {constant(initial_[i]), constant(0), constant(0), false};
      for (; mixed != mixed_.end() && mixed->row == i; ++mixed)
        from.convex = from.convex + mixed->weight * values_[mixed->column];
      for (; coupled != coupled_.end() && coupled->row == i; ++coupled) {
        from.coupled = from.coupled + coupled->weight * values_[coupled->column];
        if (far && has_update_)
          from.collision = from.collision + coupled->weight * collisions_[coupled->column];
        from.is_coupled = true;
      }
      values_.push_back(far ? far_stage(i, from, middle, half) : near_stage(i, from, middle, half));
      if (far && has_update_) collisions_.push_back(far_collision(i, from, middle, half));
    }
    return values_.back();
  }

 private:
  struct entry {
    std::size_t row, column;
    real weight;
  };

  /// Contributions of earlier stages y_j: Σ (p + w) y_j including u^n, Σ d_ij y_j, and z times the latter.
  struct source {
    enclosure convex, coupled, collision;
    bool is_coupled;
  };

  bool is_implicit(std::size_t i) const { return m_.D(i, i) != 0 || m_.ddot[i] != 0; }

  /// (convex + z coupled)/(1 − zd − z²ḋ).
  enclosure near_stage(std::size_t i, const source& from, real middle, real half) const {
    const complex u = direction_;
    const enclosure sum =
        from.is_coupled ? from.convex + quadratic(0, u, 0, middle, half) * from.coupled : from.convex;
    if (!is_implicit(i)) return sum;
    return sum * inverse(quadratic(1, -m_.D(i, i) * u, -m_.ddot[i] * times(u, u), middle, half));
  }

  /// The denominator times t² = 1/|z|², or times t where ḋ = 0.
  enclosure far_denominator(std::size_t i, real middle, real half) const {
    const complex u = direction_;
    const real d = m_.D(i, i), ddot = m_.ddot[i];
    return ddot == 0 ? quadratic(-d * u, 1, 0, middle, half)
                     : quadratic(-ddot * times(u, u), -d * u, 1, middle, half);
  }

  enclosure far_stage(std::size_t i, const source& from, real middle, real half) const {
    if (!is_implicit(i)) return from.is_coupled ? from.convex + from.collision : from.convex;
    const bool once = m_.ddot[i] == 0;
    enclosure sum =
        (once ? quadratic(0, 1, 0, middle, half) : quadratic(0, 0, 1, middle, half)) * from.convex;
    if (from.is_coupled)
      sum = sum + (once ? constant(direction_) : quadratic(0, direction_, 0, middle, half)) * from.coupled;
    return sum * inverse(far_denominator(i, middle, half));
  }

  /// z y_i, which is bounded for z → ∞ unless stage i is explicit.
  enclosure far_collision(std::size_t i, const source& from, real middle, real half) const {
    const enclosure sum = from.is_coupled ? from.convex + from.collision : from.convex;
    if (!is_implicit(i)) return constant(direction_) * inverse(quadratic(0, 1, 0, middle, half)) * sum;
    const enclosure factor =
        m_.ddot[i] == 0 ? constant(direction_) : quadratic(0, direction_, 0, middle, half);
    return factor * sum * inverse(far_denominator(i, middle, half));
  }

  const shu_osher_form<real>& m_;
  complex direction_;
  std::vector<real> initial_;
  std::vector<entry> mixed_, coupled_;  ///< row by row
  bool has_update_ = false;             ///< Q of earlier stages enters a stage without implicit part
  std::vector<enclosure> values_, collisions_;
};

/// Range of d|R|²/dt = 2 Re(R̄ R′): middle and radius.
std::pair<real, real> slope_of_square(const enclosure& R) {
  const real middle =
      2 * (R.value.middle.real() * R.slope.middle.real() + R.value.middle.imag() * R.slope.middle.imag());
  const real radius = 2 * (modulus(R.value.middle) * R.slope.radius +
                           modulus(R.slope.middle) * R.value.radius + R.value.radius * R.slope.radius);
  return {middle, radius};
}

constexpr real allowance = 1e-14L;

/// Whether |R|² ≤ 1 is proved for 0 ≤ t ≤ 1.
bool is_stable_part(ray& R, bool far) {
  struct interval {
    real begin, length;
  };
  std::vector<interval> left = {{0, 1}};
  constexpr int most = 200'000;  // family members with 64 stages need a few thousand
  for (int taken = 0; !left.empty(); ++taken) {
    if (taken == most) return false;
    const auto [begin, length] = left.back();
    left.pop_back();
    const real half = length / 2, middle = begin + half;
    const real value = std::norm(R(middle, 0, far).value.middle);
    if (!(value <= 1 + allowance)) return false;
    const enclosure range = R(middle, half, far);
    if (std::isfinite(range.value.radius) && std::isfinite(range.slope.radius)) {
      const auto [slope, spread] = slope_of_square(range);
      if (value + half * (std::abs(slope) + spread) <= 1 + allowance) continue;
      // |R| = 1 at t = 0 and decreases; for `far`, t = 0 is z = ∞, where R is checked separately.
      if (begin == 0 && slope + spread <= 0) {
        if (!far || std::norm(R(0, 0, far).value.middle) <= 1 + allowance) continue;
      }
      if (std::pow(modulus(range.value.middle) + range.value.radius, 2) <= 1 + allowance) continue;
    }
    constexpr real shortest = 1e-12L;
    if (length <= shortest * (begin + shortest)) return false;
    left.push_back({middle, half});
    left.push_back({begin, half});
  }
  return true;
}

}  // namespace

bool is_stable_ray(const shu_osher_form<long double>& m, long double degrees) {
  const real radians = degrees * std::numbers::pi_v<real> / 180;
  ray R(m, complex(-std::cos(radians), -std::sin(radians)));
  return is_stable_part(R, false) && is_stable_part(R, true);
}

}  // namespace apsis
