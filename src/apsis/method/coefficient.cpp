#include <apsis/method/coefficient.hpp>

#include <cctype>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Advances i past the digits that begin at i, and returns their number.
std::size_t digits(const std::string& text, std::size_t& i) {
  const std::size_t start = i;
  while (i < text.size() && is_digit(text[i])) ++i;
  return i - start;
}

}  // namespace

bool is_coefficient(const std::string& text) {
  constexpr std::size_t longest = 200;
  if (text.size() > longest) return false;
  std::size_t i = 0;
  if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
  const std::size_t whole = digits(text, i);
  if (i < text.size() && text[i] == '/') {
    ++i;
    const std::size_t start = i;
    const bool some = digits(text, i) > 0 && whole > 0 && i == text.size();
    return some && text.find_first_not_of('0', start) != std::string::npos;
  }
  std::size_t fraction = 0;
  if (i < text.size() && text[i] == '.') {
    ++i;
    fraction = digits(text, i);
  }
  if (whole + fraction == 0) return false;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) ++i;
    const std::size_t exponent = digits(text, i);
    if (exponent == 0 || exponent > 3) return false;
  }
  return i == text.size();
}

mp_real coefficient_value(const std::string& text) {
  const std::string unsigned_text = text[0] == '+' ? text.substr(1) : text;
  const auto slash = unsigned_text.find('/');
  if (slash == std::string::npos) return mp_real(unsigned_text);
  return mp_real(unsigned_text.substr(0, slash)) / mp_real(unsigned_text.substr(slash + 1));
}

std::string negated(const std::string& text) {
  if (coefficient_value(text) == 0) return text;
  return text[0] == '-' ? text.substr(1) : "-" + (text[0] == '+' ? text.substr(1) : text);
}

int decimals(const std::string& text) {
  const auto point = text.find('.');
  if (point == std::string::npos) return 0;
  std::size_t i = point + 1;
  const auto count = static_cast<int>(digits(text, i));
  constexpr int shortest = 12;  // "0.25" means exactly 1/4, not a number known to two digits
  return count >= shortest ? count : 0;
}

mp_real residual_tolerance(int decimals) {
  return decimals > 0 ? pow(mp_real(10), 3 - decimals) : mp_real(1e-50);
}

std::string coefficient_text(const mp_real& x, int decimals) {
  const mp_real rounding("1e-50");
  if (abs(x) < rounding) return "0";
  // Convergents p/q of the continued fraction of |x|.
  constexpr long most = 1'000'000;
  mp_real rest = abs(x);
  long p = 1, q = 0, previous_p = 0, previous_q = 1;
  while (rest < most) {
    const long whole = floor(rest + rounding).convert_to<long>();
    const long next_p = whole * p + previous_p, next_q = whole * q + previous_q;
    if (next_q > most || next_p > most) break;
    previous_p = std::exchange(p, next_p);
    previous_q = std::exchange(q, next_q);
    if (abs(abs(x) * q - p) < rounding * q)
      return fmt::format("{}{}{}", x < 0 ? "-" : "", p, q == 1 ? "" : fmt::format("/{}", q));
    rest = 1 / (rest - whole);
  }
  return x.str(decimals, std::ios_base::fixed);
}

std::string short_text(const mp_real& x) {
  return x.str(12);
}

}  // namespace apsis
