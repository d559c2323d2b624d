#include <apsis/method/precision.hpp>
#include <apsis/method/stable_ray.hpp>

#include <algorithm>
#include <vector>

namespace apsis {
namespace {

/// Coefficients of 1, x, x², …
using polynomial = std::vector<mp_real>;

void add(polynomial& sum, const mp_real& factor, const polynomial& term, std::size_t shift) {
  if (sum.size() < term.size() + shift) sum.resize(term.size() + shift, mp_real(0));
  for (std::size_t k = 0; k < term.size(); ++k) sum[k + shift] += factor * term[k];
}

polynomial product(const polynomial& a, const polynomial& b) {
  polynomial out;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k] != 0) add(out, a[k], b, k);
  return out;
}

struct fraction {
  polynomial numerator, denominator;
};

/// Returns R(z) without cancelling common factors: the numerator of the last stage over the product
/// of all denominators.
fraction stability_fraction(const shu_osher_form<long double>& m) {
  const auto initial = initial_weights(m);
  polynomial denominator = {mp_real(1)};
  std::vector<polynomial> stages;
  for (std::size_t i = 0; i < m.stages(); ++i) {
    polynomial stage;
    add(stage, mp_real(initial[i]), denominator, 0);
    for (std::size_t j = 0; j < i; ++j) {
      if (const long double mixed = m.P(i, j) + m.W(i, j); mixed != 0)
        add(stage, mp_real(mixed), stages[j], 0);
      if (m.D(i, j) != 0) add(stage, mp_real(m.D(i, j)), stages[j], 1);
    }
    if (m.D(i, i) != 0 || m.ddot[i] != 0) {
      const polynomial factor = {mp_real(1), mp_real(-m.D(i, i)), mp_real(-m.ddot[i])};
      for (auto& earlier : stages) earlier = product(factor, earlier);
      denominator = product(factor, denominator);
    }
    stages.push_back(std::move(stage));
  }
  return {stages.back(), denominator};
}

/// |p(iy)|² as a polynomial in x = y²: p(iy) = a(x) + iy b(x).
polynomial square_on_imaginary_axis(const polynomial& p) {
  polynomial a, b;
  for (std::size_t k = 0; k < p.size(); ++k)
    (k % 2 == 0 ? a : b).push_back((k / 2) % 2 == 0 ? p[k] : mp_real(-p[k]));
  polynomial out = product(a, a);
  add(out, mp_real(1), product(b, b), 1);
  return out;
}

/// |p(iy)|² with absolute values of all terms: a scale for the cancellation in each coefficient.
polynomial terms_on_imaginary_axis(const polynomial& p) {
  polynomial a, b;
  for (std::size_t k = 0; k < p.size(); ++k) (k % 2 == 0 ? a : b).push_back(abs(p[k]));
  polynomial out = product(a, a);
  add(out, mp_real(1), product(b, b), 1);
  return out;
}

/// Converts to the Bernstein basis of [0, 1].
polynomial bernstein(const polynomial& p) {
  polynomial out = p;
  const std::size_t n = p.size() - 1;
  for (std::size_t k = 1; k <= n; ++k) {  // c_k/binomial(n, k), then sums along the triangle
    mp_real binomial(1);
    for (std::size_t j = 0; j < k; ++j) binomial = binomial * mp_real(n - j) / mp_real(j + 1);
    out[k] /= binomial;
  }
  for (std::size_t level = 1; level <= n; ++level)
    for (std::size_t k = n; k >= level; --k) out[k] += out[k - 1];
  return out;
}

/// Whether the polynomial with these Bernstein coefficients is proved to be ≥ 0 on its interval, by bisection
/// up to `depth` levels.
bool is_nonnegative(polynomial b, int depth) {
  if (std::all_of(b.begin(), b.end(), [](const mp_real& x) { return x >= 0; })) return true;
  if (depth == 0 || b.front() < 0 || b.back() < 0) return false;
  polynomial right(b.size());
  for (std::size_t level = 0; level < b.size(); ++level) {  // de Casteljau at 1/2
    right[b.size() - 1 - level] = b.back();
    for (std::size_t k = b.size() - 1; k > level; --k) b[k] = (b[k] + b[k - 1]) / 2;
  }
  return is_nonnegative(b, depth - 1) && is_nonnegative(right, depth - 1);
}

}  // namespace

bool is_stable_imaginary_axis(const shu_osher_form<long double>& m) {
  const auto [numerator, denominator] = stability_fraction(m);
  polynomial difference = square_on_imaginary_axis(denominator), size = terms_on_imaginary_axis(denominator);
  add(difference, mp_real(-1), square_on_imaginary_axis(numerator), 0);
  add(size, mp_real(1), terms_on_imaginary_axis(numerator), 0);
  constexpr double rounding = 1e-15;
  for (std::size_t k = 0; k < difference.size(); ++k)
    if (abs(difference[k]) <= rounding * size[k]) difference[k] = 0;
  constexpr int depth = 40;
  if (!is_nonnegative(bernstein(difference), depth)) return false;  // 0 ≤ y² ≤ 1
  std::reverse(difference.begin(), difference.end());
  return is_nonnegative(bernstein(difference), depth);  // y² ≥ 1, in 1/y²
}

}  // namespace apsis
