#include <paper/ode_study.hpp>

#include <cmath>

namespace apsis::paper {

double halving_slope(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size()), middle = (n - 1) / 2;
  double product = 0, square = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double x = middle - static_cast<double>(k);
    product += x * std::log2(values[k]);
    square += x * x;
  }
  return product / square;
}

}  // namespace apsis::paper
