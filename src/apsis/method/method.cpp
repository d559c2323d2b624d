#include <apsis/method/method.hpp>

#include <apsis/method/coefficient.hpp>

#include <cmath>
#include <type_traits>

namespace apsis {

std::string to_string(method_kind kind) {
  switch (kind) {
    case method_kind::implicit_only:
      return "implicit";
    case method_kind::imex:
      return "imex";
    case method_kind::explicit_only:
      return "explicit";
    case method_kind::exact_collision:
      return "exponential";
  }
  return "";
}

bool solves_exactly(method_kind kind) {
  return kind == method_kind::exact_collision;
}

bool has_derivatives(method_kind kind) {
  return kind == method_kind::imex || kind == method_kind::implicit_only;
}

tree_colours colours_of(method_kind kind) {
  switch (kind) {
    case method_kind::implicit_only:
      return tree_colours::G_only;
    case method_kind::explicit_only:
      return tree_colours::F_only;
    case method_kind::imex:
    case method_kind::exact_collision:
      break;
  }
  return tree_colours::both;
}

bool method::ends_with_update() const {
  const std::size_t last = stages() - 1;
  return kind != method_kind::explicit_only && coefficient_value(exact.D(last, last)) == 0 &&
         coefficient_value(exact.ddot[last]) == 0;
}

bool method::is_tableau() const {
  for (std::size_t i = 0; i < stages(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (coefficient_value(exact.D(i, j)) != 0) return true;
  return false;
}

method method::with_embedded_row() const {
  const std::size_t s = stages();
  const auto grown = [s](const matrix<std::string>& rows, const std::vector<std::string>& last) {
    matrix<std::string> all(s + 1, s + 1);
    for (std::size_t i = 0; i <= s; ++i)
      for (std::size_t j = 0; j <= s; ++j) all(i, j) = i < s && j < s ? rows(i, j) : "0";
    for (std::size_t j = 0; j < last.size(); ++j) all(s, j) = last[j];
    return all;
  };
  method m = *this;
  m.claims = {};
  m.claims.order = embedded->order;
  m.embedded.reset();
  m.exact.P = grown(exact.P, embedded->P);
  m.exact.W = grown(exact.W, embedded->W);
  // A tableau has the same weights for T and Q.
  m.exact.D = grown(exact.D, is_tableau() ? embedded->W : std::vector<std::string>{});
  m.exact.D(s, s) = embedded->d;
  m.exact.ddot.push_back(embedded->ddot);
  return m;
}

int method::precision() const {
  int most = 0;
  const auto consider = [&most](const std::string& text) { most = std::max(most, decimals(text)); };
  for (std::size_t i = 0; i < stages(); ++i) {
    consider(exact.ddot[i]);
    for (std::size_t j = 0; j <= i; ++j) {
      consider(exact.P(i, j));
      consider(exact.W(i, j));
      consider(exact.D(i, j));
    }
  }
  consider(exact.r);
  return most;
}

namespace {

template <class Real>
Real convert(const mp_real& x) {
  if constexpr (std::is_same_v<Real, mp_real>) {
    return x;
  } else {
    return x.convert_to<Real>();
  }
}

/// Rounds a weight to the grid of spacing 2^−digits, that of numbers in [½, 1).
template <class Real>
Real on_grid(const mp_real& x) {
  if constexpr (std::is_same_v<Real, mp_real>) {
    return x;
  } else {
    constexpr int digits = std::numeric_limits<Real>::digits;
    return std::ldexp(convert<Real>(round(ldexp(x, digits))), -digits);
  }
}

/// Sets row i of P and W. Rounding preserves a weight of u^n that is 0 (up to `nothing`), and it makes no
/// positive weight of u^n negative.
template <class Real>
void set_row(const shu_osher_form<std::string>& exact, std::size_t i, const mp_real& nothing,
             shu_osher_form<Real>& m) {
  mp_real rest(1), largest_value(0);
  Real left(1);
  Real* largest = nullptr;
  const auto set = [&](const std::string& text, Real& weight) {
    const mp_real value = coefficient_value(text);
    weight = on_grid<Real>(value);
    rest -= value;
    left -= weight;
    if (value > largest_value) {
      largest_value = value;
      largest = &weight;
    }
  };
  for (std::size_t j = 0; j < i; ++j) {
    set(exact.P(i, j), m.P(i, j));
    set(exact.W(i, j), m.W(i, j));
  }
  if ((abs(rest) <= nothing || (rest > 0 && left < 0)) && largest != nullptr) *largest += left;
}

}  // namespace

template <class Real>
shu_osher_form<Real> method::coefficients() const {
  const std::size_t s = stages();
  const int digits = precision();
  // Decimal weights sum to 1 only to the accuracy of their digits.
  const mp_real nothing = digits > 0 ? mp_real(10) * pow(mp_real(10), -digits) : mp_real(1e-50);
  shu_osher_form<Real> m;
  m.P = m.W = m.D = matrix<Real>(s, s);
  m.r = convert<Real>(coefficient_value(exact.r));
  for (std::size_t i = 0; i < s; ++i) {
    set_row(exact, i, nothing, m);
    m.ddot.push_back(convert<Real>(coefficient_value(exact.ddot[i])));
    for (std::size_t j = 0; j <= i; ++j)
      m.D(i, j) = kind == method_kind::explicit_only ? Real(m.W(i, j) / m.r)
                                                     : convert<Real>(coefficient_value(exact.D(i, j)));
  }
  return m;
}

template shu_osher_form<double> method::coefficients() const;
template shu_osher_form<long double> method::coefficients() const;
template shu_osher_form<mp_real> method::coefficients() const;

}  // namespace apsis
