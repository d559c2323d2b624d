#pragma once

#include <apsis/core/embedded.hpp>
#include <apsis/method/certificate.hpp>
#include <apsis/method/method.hpp>
#include <apsis/method/precision.hpp>
#include <apsis/method/tableau.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace apsis::test {

using numbers = std::vector<double>;

/// Uniform random numbers in (−1, 1), equal on every platform.
class noise {
 public:
  explicit noise(std::uint64_t seed) : state_(seed * 2654435761U + 88172645463325252U) {}
  double operator()() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<double>(state_ >> 11) / 4503599627370496.0 - 1.0;
  }

 private:
  std::uint64_t state_;
};

/// Returns a random lower triangular tableau without further structure.
inline butcher_form<double> random_tableau(std::size_t s, std::uint64_t seed) {
  noise draw(seed);
  butcher_form<double> b{matrix<double>(s, s), matrix<double>(s, s), matrix<double>(s, s)};
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      b.A(i, j) = draw();
      b.A_dot(i, j) = draw();
      if (j < i) b.A_hat(i, j) = draw();
    }
  return b;
}

/// Returns the text of a method file of the catalogue.
inline std::string catalogue_text(const std::string& name) {
  for (const auto& file : embedded::methods())
    if (file.name == name) return std::string(file.text);
  return "";
}

/// Returns a method file with the mandatory keys and the given table of coefficients.
inline std::string method_text(const std::string& name, const std::string& kind, int order,
                               const std::string& coefficients) {
  return "name = \"" + name + "\"\ntitle = \"\"\ncitation = \"\"\nkind = \"" + kind +
         "\"\n[claims]\norder = " + std::to_string(order) + "\n" + coefficients;
}

}  // namespace apsis::test
