#include <apsis/method/tableau.hpp>

#include <apsis/method/lower_product.hpp>
#include <apsis/method/precision.hpp>

namespace apsis {

template <class Real>
std::vector<Real> initial_weights(const shu_osher_form<Real>& m) {
  std::vector<Real> weights;
  for (std::size_t i = 0; i < m.stages(); ++i) {
    Real rest(1);
    for (std::size_t j = 0; j < i; ++j) rest -= m.P(i, j) + m.W(i, j);
    weights.push_back(rest);
  }
  return weights;
}

template <class Real>
butcher_form<Real> to_butcher(const shu_osher_form<Real>& m) {
  const std::size_t s = m.stages();
  auto R = matrix<Real>::identity(s);
  matrix<Real> explicit_part(s, s), derivative(s, s);
  for (std::size_t i = 0; i < s; ++i) {
    derivative(i, i) = m.ddot[i];
    for (std::size_t j = 0; j < i; ++j) {
      R(i, j) -= m.P(i, j) + m.W(i, j);
      explicit_part(i, j) = m.W(i, j) / m.r;
    }
  }
  const auto inverse = inverse_lower(R);
  return {lower_product(inverse, explicit_part), lower_product(inverse, m.D),
          lower_product(inverse, derivative)};
}

template <class Real>
shu_osher_form<Real> to_shu_osher(const butcher_form<Real>& b, const matrix<Real>& R, const Real& r) {
  const std::size_t s = b.stages();
  shu_osher_form<Real> m;
  m.r = r;
  m.P = matrix<Real>(s, s);
  m.W = R * b.A_hat;
  m.D = R * b.A;
  const auto derivative = R * b.A_dot;
  for (std::size_t i = 0; i < s; ++i) {
    m.ddot.push_back(derivative(i, i));
    for (std::size_t j = 0; j < i; ++j) {
      m.W(i, j) *= r;
      m.P(i, j) = -R(i, j) - m.W(i, j);
    }
  }
  return m;
}

#define APSIS_INSTANTIATE(Real)                                            \
  template std::vector<Real> initial_weights(const shu_osher_form<Real>&); \
  template butcher_form<Real> to_butcher(const shu_osher_form<Real>&);     \
  template shu_osher_form<Real> to_shu_osher(const butcher_form<Real>&, const matrix<Real>&, const Real&);
APSIS_INSTANTIATE(double)
APSIS_INSTANTIATE(long double)
APSIS_INSTANTIATE(mp_real)
#undef APSIS_INSTANTIATE

}  // namespace apsis
