#pragma once

#include <apsis/method/tableau.hpp>

#include <rapidcheck.h>

namespace random_input {

/// Returns a form of up to seven stages with a random zero pattern, including off-diagonal Q. Callable only
/// inside a property.
inline apsis::shu_osher_form<double> form(std::size_t fewest_stages) {
  const auto s = *rc::gen::inRange<std::size_t>(fewest_stages, 8);
  const auto number = [] { return *rc::gen::inRange(0, 3) == 0 ? *rc::gen::inRange(1, 1000) * 1e-3 : 0.0; };
  apsis::shu_osher_form<double> m;
  m.P = m.W = m.D = apsis::matrix<double>(s, s);
  m.r = 0.7;
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      m.P(i, j) = number() / static_cast<double>(s);
      m.W(i, j) = number() / static_cast<double>(s);
      m.D(i, j) = number() - number();
    }
    m.D(i, i) = number();
    m.ddot.push_back(-number());
  }
  return m;
}

}  // namespace random_input
