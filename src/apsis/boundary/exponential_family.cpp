#include <apsis/boundary/exponential_family.hpp>

#include <algorithm>
#include <cmath>

namespace apsis {
namespace {

using family_vector = exponential_family::vector;

/// The sums Σ m c^p, p = 0 … 4, along a line.
struct line_powers_of_flux {
  double s0 = 0.0, s1 = 0.0, s2 = 0.0, s3 = 0.0, s4 = 0.0;
};

line_powers_of_flux powers_of(const double* flux, const double* factor, const double* c, std::size_t n) {
  double s0 = 0.0, s1 = 0.0, s2 = 0.0, s3 = 0.0, s4 = 0.0;
#pragma omp simd reduction(+ : s0, s1, s2, s3, s4)
  for (std::size_t i = 0; i < n; ++i) {
    const double m = flux[i] * factor[i], m1 = m * c[i], m2 = m1 * c[i], m3 = m2 * c[i];
    s0 += m;
    s1 += m1;
    s2 += m2;
    s3 += m3;
    s4 += m3 * c[i];
  }
  return {s0, s1, s2, s3, s4};
}

/// Solves the symmetric positive definite system H x = b of n unknowns by Cholesky's method; x replaces b.
/// Returns false if H is singular to rounding.
bool solve_definite(std::array<family_vector, 5>& h, family_vector& b, std::size_t n) {
  constexpr double least_pivot = 1e-13;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = h[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= h[i][k] * h[j][k];
      if (j < i) {
        h[i][j] = sum / h[j][j];
      } else {
        if (!(sum > least_pivot * h[i][i])) return false;
        h[i][i] = std::sqrt(sum);
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= h[i][k] * b[k];
    b[i] /= h[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= h[k][i] * b[k];
    b[i] /= h[i][i];
  }
  return true;
}

double product(const family_vector& a, const family_vector& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// A step of Newton's method along the vectors of a basis.
struct newton_step {
  family_vector step{};
  double residual = 0.0;  ///< largest residual of the sums, relative to the wanted ones
  double slope = 0.0;     ///< directional derivative along the step
  bool is_found = false;
};

newton_step step_from(const exponential_family::sums& at, const family_vector& wanted,
                      std::span<const family_vector> basis) {
  newton_step made;
  family_vector gradient{}, b{};
  std::array<family_vector, 5> h{};
  for (std::size_t k = 0; k < gradient.size(); ++k) gradient[k] = at.first[k] - wanted[k];
  const double size = std::abs(wanted[0]);
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const double along = product(basis[i], gradient), of_wanted = std::abs(product(basis[i], wanted));
    const double residual = std::abs(along) / (size + of_wanted);
    if (!(residual <= made.residual)) made.residual = residual;  // also NaN
    b[i] = -along;
    family_vector image{};
    for (std::size_t k = 0; k < image.size(); ++k) image[k] = product(at.second[k], basis[i]);
    for (std::size_t j = 0; j <= i; ++j) h[i][j] = product(basis[j], image);
  }
  const family_vector downhill = b;
  made.is_found = solve_definite(h, b, basis.size());
  for (std::size_t i = 0; i < basis.size(); ++i) {
    made.slope -= downhill[i] * b[i];
    for (std::size_t k = 0; k < made.step.size(); ++k) made.step[k] += b[i] * basis[i][k];
  }
  return made;
}

}  // namespace

exponential_family::exponential_family(const tensor_axes& axes, const std::array<double, 3>& origin,
                                       double unit)
    : axes_(axes) {
  for (std::size_t k = 0; k < axes.dimensions(); ++k) {
    offsets_[k] = c_.size();
    for (const double v : axes.points(k)) c_.push_back((v - origin[k]) / unit);
  }
}

bool exponential_family::tabulate(const vector& multipliers, table& factors) const {
  constexpr double most = 300.0;
  const std::size_t d = axes_.dimensions();
  factors.resize(c_.size());
  bool is_moderate = std::abs(multipliers[0]) < most;
  for (std::size_t k = 0; k < d; ++k) {
    const double slope = multipliers[k + 1], curvature = 0.5 * multipliers[d + 1];
    for (std::size_t i = offsets_[k]; i < offsets_[k] + axes_.points(k).size(); ++i) {
      const double exponent = c_[i] * (slope + curvature * c_[i]) + (k == 0 ? multipliers[0] : 0.0);
      is_moderate = is_moderate && exponent < most;
      factors[i] = std::exp(exponent);
    }
  }
  return is_moderate;
}

double exponential_family::largest_exponent(const vector& multipliers) const {
  const std::size_t d = axes_.dimensions();
  double sum = 0.0;
  for (std::size_t k = 0; k < d; ++k) {
    double most = 0.0;
    for (std::size_t i = offsets_[k]; i < offsets_[k] + axes_.points(k).size(); ++i)
      most = std::max(most, std::abs(c_[i] * (multipliers[k + 1] + 0.5 * multipliers[d + 1] * c_[i])));
    sum += most;
  }
  return sum;
}

double exponential_family::factor_of_line(const table& factors,
                                          const std::array<std::size_t, 3>& indices) const {
  double factor = 1.0;
  for (std::size_t k = 0; k + 1 < axes_.dimensions(); ++k) factor *= factors[offsets_[k] + indices[k]];
  return factor;
}

exponential_family::sums exponential_family::sum(const double* flux, const table& factors) const {
  const std::size_t d = axes_.dimensions(), e = d + 1, n = axes_.last().size();
  const double* along = last(factors);
  const double* c = c_.data() + offsets_[d - 1];
  sums all;
  for (std::size_t line = 0; line < axes_.lines(); ++line) {
    const auto indices = axes_.indices_of_line(line);
    const double common = factor_of_line(factors, indices);
    const auto [s0, s1, s2, s3, s4] = powers_of(flux + line * n, along, c, n);
    std::array<double, 3> o{};
    double half_square = 0.0;
    for (std::size_t k = 0; k + 1 < d; ++k) {
      o[k] = c_[offsets_[k] + indices[k]];
      half_square += 0.5 * o[k] * o[k];
    }
    const double energy = half_square * s0 + 0.5 * s2;
    all.first[0] += common * s0;
    all.first[d] += common * s1;
    all.first[e] += common * energy;
    for (std::size_t k = 0; k + 1 < d; ++k) {
      all.first[k + 1] += common * o[k] * s0;
      for (std::size_t l = 0; l <= k; ++l) all.second[k + 1][l + 1] += common * o[k] * o[l] * s0;
      all.second[d][k + 1] += common * o[k] * s1;
      all.second[e][k + 1] += common * o[k] * energy;
    }
    all.second[d][d] += common * s2;
    all.second[e][d] += common * (half_square * s1 + 0.5 * s3);
    all.second[e][e] += common * (half_square * (half_square * s0 + s2) + 0.25 * s4);
  }
  for (std::size_t k = 0; k <= e; ++k) all.second[k][0] = all.first[k];
  for (std::size_t k = 0; k <= e; ++k)
    for (std::size_t l = 0; l < k; ++l) all.second[l][k] = all.second[k][l];
  return all;
}

exponential_family::match exponential_family::solve(const double* flux, const vector& wanted,
                                                    std::span<const vector> basis,
                                                    const vector& start) const {
  constexpr double rounding = 3e-15, enough = 2e-14, of_values = 1e-13, of_slope = 1e-4, shortest = 1e-3;
  constexpr int most_passes = 40;
  table factors;
  match made{.multipliers = start};
  if (!tabulate(start, factors)) return made;
  sums at = sum(flux, factors);
  made.passes = 1;
  double previous = 1.0;
  while (made.passes < most_passes) {
    const newton_step next = step_from(at, wanted, basis);
    made.total = at.first[0];
    made.is_solved =
        next.residual <= rounding || (next.residual <= enough && next.residual >= 0.5 * previous);
    if (made.is_solved || !next.is_found || !std::isfinite(next.slope)) return made;
    previous = next.residual;
    const double value = at.first[0] - product(made.multipliers, wanted);
    vector tried{};
    double share = 1.0;
    for (bool is_lower = false; !is_lower; share *= 0.5) {
      if (share < shortest || made.passes >= most_passes) return made;
      for (std::size_t k = 0; k < tried.size(); ++k) tried[k] = made.multipliers[k] + share * next.step[k];
      if (!tabulate(tried, factors)) continue;
      at = sum(flux, factors);
      ++made.passes;
      is_lower = at.first[0] - product(tried, wanted) <=
                 value + of_slope * share * next.slope + of_values * std::abs(wanted[0]);
    }
    made.multipliers = tried;
  }
  return made;
}

}  // namespace apsis
