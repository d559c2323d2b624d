#include <apsis/method/amplification.hpp>

#include <apsis/method/internal/complex_product.hpp>

#include <cmath>
#include <utility>

namespace apsis {

amplification::amplification(const method& m) : kind_(m.kind), steps_(m.steps) {
  set_rows(m);
}

amplification::amplification(linear_formula<double> m)
    : kind_(method_kind::imex), steps_(m.steps()), formula_(std::move(m)) {}

amplification::amplification(multistage_formula<double> m)
    : kind_(method_kind::imex), steps_(static_cast<int>(m.stages()) + 1), staged_(std::move(m)) {}

void amplification::set_rows(const method& m) {
  const auto form = m.coefficients<double>();
  const auto initial = initial_weights(form);
  for (std::size_t i = 0; i < form.stages(); ++i) {
    row r{initial[i], form.D(i, i), form.ddot[i], {}};
    for (std::size_t j = 0; j < i; ++j) {
      const double value = form.P(i, j) + form.W(i, j), transport = form.W(i, j) / form.r;
      if (value != 0.0 || transport != 0.0 || form.D(i, j) != 0.0)
        r.entries.push_back({j, value, transport, form.D(i, j)});
    }
    rows_.push_back(std::move(r));
  }
}

std::vector<double> amplification::fingerprint() const {
  std::vector<double> all = {static_cast<double>(kind_), static_cast<double>(steps_)};
  for (const row& r : rows_) {
    all.insert(all.end(), {r.initial, r.d, r.ddot, static_cast<double>(r.entries.size())});
    for (const entry& e : r.entries)
      all.insert(all.end(), {static_cast<double>(e.column), e.value, e.transport, e.collision});
  }
  all.push_back(formula_.b);
  all.insert(all.end(), formula_.a.begin(), formula_.a.end());
  all.insert(all.end(), formula_.c.begin(), formula_.c.end());
  all.insert(all.end(), staged_.v.begin(), staged_.v.end());
  for (const auto* part : {&staged_.A, &staged_.A_hat, &staged_.B, &staged_.B_hat})
    for (std::size_t i = 0; i < part->rows(); ++i)
      for (std::size_t j = 0; j < part->cols(); ++j) all.push_back((*part)(i, j));
  return all;
}

amplification::complex amplification::relaxed(const row& r, complex stage, double w) const {
  if (solves_exactly(kind_)) return std::exp(r.d * w) * stage;
  return stage / (1.0 - r.d * w - r.ddot * w * w);
}

/// Computes u_s = stages_.back() u^n + before_.back() u^{n−1}; the first row of a two-step method is u^{n−1}.
void amplification::find_two_steps(complex z, double w) const {
  if (kind_ == method_kind::explicit_only) {
    z += w;
    w = 0.0;
  }
  stages_.clear();
  before_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (i == 0 && steps_ == 2) {
      stages_.emplace_back(0.0);
      before_.emplace_back(1.0);
      continue;
    }
    const row& r = rows_[i];
    complex now = r.initial, earlier = 0.0;
    for (const entry& e : r.entries) {
      const complex factor = e.value + e.transport * z + e.collision * w;
      now += times(factor, stages_[e.column]);
      if (steps_ == 2) earlier += times(factor, before_[e.column]);
    }
    stages_.push_back(relaxed(r, now, w));
    before_.push_back(relaxed(r, earlier, w));
  }
}

/// Sets the characteristic polynomial of M = V + (zB̂ + wB)(I − zÂ − wA)⁻¹ (Faddeev and Le Verrier).
void amplification::set_polynomial_of_stages(complex z, double w) const {
  const std::size_t s = staged_.stages();
  matrix<complex> solved(s, s), M(s, s);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t column = 0; column < s; ++column) {
      complex sum = i == column ? 1.0 : 0.0;
      for (std::size_t j = 0; j < i; ++j)
        sum += times(z * staged_.A_hat(i, j) + w * staged_.A(i, j), solved(j, column));
      solved(i, column) = sum / (1.0 - w * staged_.lambda());
    }
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t column = 0; column < s; ++column) {
      M(i, column) = staged_.v[column];
      for (std::size_t j = 0; j < s; ++j)
        M(i, column) += times(z * staged_.B_hat(i, j) + w * staged_.B(i, j), solved(j, column));
    }
  polynomial_.assign(s + 1, 0.0);
  polynomial_[s] = 1.0;
  auto power = matrix<complex>(s, s);
  for (std::size_t k = 1; k <= s; ++k) {
    for (std::size_t i = 0; i < s; ++i) power(i, i) += polynomial_[s + 1 - k];
    power = M * power;
    complex trace = 0.0;
    for (std::size_t i = 0; i < s; ++i) trace += power(i, i);
    polynomial_[s - k] = -trace / static_cast<double>(k);
  }
}

bool amplification::is_within(double bound, complex z, double w) const {
  if (!rows_.empty()) {
    find_two_steps(z, w);
    if (steps_ == 1) return std::norm(stages_.back()) < bound * bound;
    return has_roots_within({-before_.back(), -stages_.back(), 1.0}, bound);
  }
  if (staged_.stages() > 0) {
    set_polynomial_of_stages(z, w);
    return has_roots_within(polynomial_, bound);
  }
  polynomial_.assign(formula_.a.size() + 1, 0.0);
  polynomial_.back() = 1.0 - formula_.b * w;
  for (std::size_t i = 0; i < formula_.a.size(); ++i)
    polynomial_[formula_.a.size() - 1 - i] = -(formula_.a[i] + formula_.c[i] * z);
  return has_roots_within(polynomial_, bound);
}

bool has_roots_within(std::vector<std::complex<double>> c, double radius) {
  double power = 1.0;
  for (auto& one : c) {
    one *= power;
    power *= radius;
  }
  while (c.size() > 1) {
    const auto first = c.front(), last = c.back();
    if (!(std::abs(first) < std::abs(last))) return false;
    // conj(c_n) p(ζ) − c_0 ζ^n conj(p(1/conj ζ)) has as many roots in the disc as p. One of them is 0: divide
    // by ζ.
    const std::size_t n = c.size() - 1;
    std::vector<std::complex<double>> reduced(n);
    for (std::size_t k = 1; k <= n; ++k)
      reduced[k - 1] = (std::conj(last) * c[k] - first * std::conj(c[n - k])) / std::norm(last);
    c = std::move(reduced);
  }
  return true;
}

}  // namespace apsis
