#include <apsis/method/exact_form.hpp>

#include <apsis/method/coefficient.hpp>
#include <apsis/method/monotonicity.hpp>

#include <algorithm>

namespace apsis {
namespace {

matrix<mp_real> values(const matrix<std::string>& texts) {
  matrix<mp_real> m(texts.rows(), texts.cols());
  for (std::size_t i = 0; i < texts.rows(); ++i)
    for (std::size_t j = 0; j < texts.cols(); ++j) m(i, j) = coefficient_value(texts(i, j));
  return m;
}

/// Returns the largest number of decimals of any coefficient; 0 if all are exact.
int decimals_of(const butcher_form<std::string>& b) {
  int digits = 0;
  for (std::size_t i = 0; i < b.stages(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      for (const auto& text : {b.A_hat(i, j), b.A(i, j), b.A_dot(i, j)})
        digits = std::max(digits, decimals(text));
  return digits;
}

std::optional<shu_osher_form<mp_real>> convex_form(const butcher_form<mp_real>& b, method_kind kind,
                                                   const mp_real& zero, std::string& reason) {
  const std::size_t s = b.stages();
  if (kind == method_kind::explicit_only) {
    const mp_real r = monotonicity_radius(b.A_hat, zero);
    auto shifted = matrix<mp_real>::identity(s);
    for (std::size_t i = 0; i < s; ++i)
      for (std::size_t j = 0; j < i; ++j) shifted(i, j) = r * b.A_hat(i, j);
    if (r > zero) return to_shu_osher(b, inverse_lower(shifted), r);
    reason = "its radius of absolute monotonicity is 0";
    return std::nullopt;
  }
  const auto analysis = analyse_imex(b, zero);
  const auto R = stage_matrix(b, zero, reason);
  if (R && analysis.exists) return to_shu_osher(b, *R, analysis.bounded ? analysis.coefficient : mp_real(1));
  reason = analysis.forbids;
  return std::nullopt;
}

/// Formats a computed coefficient with as many decimals as the file has.
std::string to_decimals(const mp_real& value, int digits) {
  return abs(value) < mp_real(1e-48) ? "0" : value.str(digits, std::ios_base::fixed);
}

/// Returns a form whose coefficients are text(value).
template <class Text>
shu_osher_form<std::string> written(const shu_osher_form<mp_real>& form, const Text& text) {
  const std::size_t s = form.stages();
  shu_osher_form<std::string> e;
  e.P = e.W = e.D = zero_coefficients(s);
  e.r = text(form.r);
  for (std::size_t i = 0; i < s; ++i) {
    e.ddot.push_back(text(form.ddot[i]));
    for (std::size_t j = 0; j <= i; ++j) {
      e.P(i, j) = text(form.P(i, j));
      e.W(i, j) = text(form.W(i, j));
      e.D(i, j) = text(form.D(i, j));
    }
  }
  return e;
}

/// Returns a convex form without rounding errors below the diagonal of D. An explicit method has no D.
shu_osher_form<mp_real> with_diagonal(shu_osher_form<mp_real> form, method_kind kind) {
  for (std::size_t i = 0; i < form.stages(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      if (j < i || kind == method_kind::explicit_only) form.D(i, j) = 0;
  return form;
}

/// Returns the form with R = I, or nothing if Ȧ is not diagonal.
std::optional<shu_osher_form<std::string>> increments(const butcher_form<std::string>& b, method_kind kind) {
  const std::size_t s = b.stages();
  shu_osher_form<std::string> e;
  e.P = zero_coefficients(s);
  e.W = b.A_hat;
  e.D = kind == method_kind::explicit_only ? zero_coefficients(s) : b.A;
  e.r = "1";
  for (std::size_t i = 0; i < s; ++i) {
    e.ddot.push_back(b.A_dot(i, i));
    for (std::size_t j = 0; j < i; ++j) {
      if (coefficient_value(b.A_dot(i, j)) != 0) return std::nullopt;
      e.P(i, j) = negated(b.A_hat(i, j));
    }
  }
  return e;
}

/// Returns the form with R = ḊȦ⁻¹, in which u_j replaces Q̇(u_j) in later stages, or nothing if the diagonal
/// of Ȧ has a zero above an entry that is not 0.
std::optional<shu_osher_form<mp_real>> without_earlier_derivatives(const butcher_form<mp_real>& b,
                                                                   const mp_real& zero) {
  const std::size_t s = b.stages();
  auto inverse = matrix<mp_real>::identity(s);
  for (std::size_t j = 0; j < s; ++j) {
    const bool own = abs(b.A_dot(j, j)) > zero;
    for (std::size_t i = j + 1; i < s; ++i) {
      if (own)
        inverse(i, j) = b.A_dot(i, j) / b.A_dot(j, j);
      else if (abs(b.A_dot(i, j)) > zero)
        return std::nullopt;
    }
  }
  return to_shu_osher(b, inverse_lower(inverse), mp_real(1));
}

}  // namespace

matrix<std::string> zero_coefficients(std::size_t s) {
  matrix<std::string> m(s, s);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < s; ++j) m(i, j) = "0";
  return m;
}

std::optional<shu_osher_form<std::string>> exact_shu_osher(const butcher_form<std::string>& b,
                                                           method_kind kind, std::string& reason) {
  const int digits = decimals_of(b);
  const mp_real zero = digits > 0 ? pow(mp_real(10), 3 - digits) : mp_real(1e-50);
  const butcher_form<mp_real> numbers{
      values(b.A_hat), values(kind == method_kind::explicit_only ? b.A_hat : b.A), values(b.A_dot)};
  const int most = digits > 0 ? std::min(digits, 50) : 50;
  if (const auto convex = convex_form(numbers, kind, zero, reason))
    return written(with_diagonal(*convex, kind),
                   [most](const mp_real& value) { return to_decimals(value, most); });
  if (auto sums = increments(b, kind)) return sums;
  if (const auto form = without_earlier_derivatives(numbers, zero))
    return written(*form, [most](const mp_real& value) { return coefficient_text(value, most); });
  return std::nullopt;
}

}  // namespace apsis
