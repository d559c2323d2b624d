#pragma once

#include <apsis/method/tableau.hpp>

#include <numeric>
#include <string>

namespace apsis {

/// Returns p/q in lowest terms as a coefficient, q > 0: "-1/8", "2".
inline std::string fraction(long p, long q) {
  const long divisor = std::gcd(p, q);
  const std::string numerator = std::to_string(p / divisor);
  return q == divisor ? numerator : numerator + "/" + std::to_string(q / divisor);
}

/// Returns a form of s stages with all coefficients zero.
inline shu_osher_form<std::string> empty_form(std::size_t s, const std::string& r) {
  shu_osher_form<std::string> form{matrix<std::string>(s, s), matrix<std::string>(s, s),
                                   matrix<std::string>(s, s), std::vector<std::string>(s, "0"), r};
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < s; ++j) form.P(i, j) = form.W(i, j) = form.D(i, j) = "0";
  return form;
}

}  // namespace apsis
