// Amplification factors of u' = λ_T u + λ_Q u for methods of all kinds.
#include <apsis/method/amplification.hpp>

#include <apsis/method/family_registry.hpp>
#include <apsis/method/kinds/imex_dimsim.hpp>
#include <apsis/method/stability.hpp>
#include <apsis/method/time_integrator.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace amplification_test {

using namespace apsis;
using complex = std::complex<double>;

namespace {

/// Returns the modulus of the largest factor by bisection of is_within().
double largest_factor(const amplification& R, complex z, double w) {
  double low = 0.0, high = 1e3;
  for (int k = 0; k < 60; ++k) {
    const double middle = (low + high) / 2.0;
    (R.is_within(middle, z, w) ? high : low) = middle;
  }
  return high;
}

complex random_in_disc() {
  const double modulus = *rc::gen::inRange(1, 1000) * 1e-3, angle = *rc::gen::inRange(0, 628) * 1e-2;
  return std::polar(modulus, angle);
}

/// Returns the matrix of a step of a general linear method for u' = (λ_T + λ_Q) u, column by column from its
/// formula.
matrix<complex> step_matrix(const multistage_formula<double>& m, complex z, double w) {
  const std::size_t s = m.stages();
  matrix<complex> M(s, s);
  for (std::size_t column = 0; column < s; ++column) {
    std::vector<complex> U(s);
    for (std::size_t i = 0; i < s; ++i) {
      complex sum = i == column ? 1.0 : 0.0;
      for (std::size_t j = 0; j < i; ++j) sum += (z * m.A_hat(i, j) + w * m.A(i, j)) * U[j];
      U[i] = sum / (1.0 - w * m.A(i, i));
    }
    for (std::size_t i = 0; i < s; ++i) {
      M(i, column) = m.v[column];
      for (std::size_t j = 0; j < s; ++j) M(i, column) += (z * m.B_hat(i, j) + w * m.B(i, j)) * U[j];
    }
  }
  return M;
}

/// Returns lim |M^k|^{1/k} by 40 squarings.
double spectral_radius(matrix<complex> M) {
  double logarithm = 0.0, exponent = 1.0;
  for (int k = 0; k < 40; ++k) {
    double largest = 0.0;
    for (std::size_t i = 0; i < M.rows(); ++i)
      for (std::size_t j = 0; j < M.rows(); ++j) largest = std::max(largest, std::abs(M(i, j)));
    for (std::size_t i = 0; i < M.rows(); ++i)
      for (std::size_t j = 0; j < M.rows(); ++j) M(i, j) /= largest;
    logarithm += std::log(largest) * exponent;
    exponent /= 2.0;
    M = M * M;
  }
  return std::exp(logarithm);
}

}  // namespace

// Bisection resolves 1e3/2⁶⁰. The stages have rounding errors of a few 1e-16.
constexpr double rounding = 1e-12;

TEST(amplification, of_explicit_methods_is_their_taylor_polynomial) {
  const amplification heun(find_method("ssprk-2-2")), third(find_method("ssprk-3-3")),
      classic(find_method("kutta-4"));
  for (const complex z : {complex(-0.3, 0.4), complex(-2.0, 0.0), complex(0.0, 1.7), complex(-1.0, -1.0)}) {
    const complex two = 1.0 + z + z * z / 2.0, three = two + z * z * z / 6.0,
                  four = three + z * z * z * z / 24.0;
    EXPECT_NEAR(largest_factor(heun, z, 0.0), std::abs(two), rounding);
    EXPECT_NEAR(largest_factor(third, z, 0.0), std::abs(three), rounding);
    EXPECT_NEAR(largest_factor(classic, z, 0.0), std::abs(four), rounding);
    // Explicit methods treat the collision like the transport.
    EXPECT_NEAR(largest_factor(classic, z + 0.5, -0.5), std::abs(four), rounding);
  }
}

TEST(amplification, without_transport_is_the_stability_function_of_the_implicit_part) {
  for (const char* name :
       {"md-imex-5-2", "md-imex-8-3-mixed", "md-imex-16-4-efficient", "ark-548", "ars-443"}) {
    const method& m = find_method(name);
    const auto b = to_butcher(m.coefficients<long double>());
    for (const double w : {-1e-2, -1.0, -30.0, -1e4})
      // Methods of type A divide by numbers up to w⁴, so rounding errors are relative to these.
      EXPECT_NEAR(largest_factor(amplification(m), 0.0, w),
                  static_cast<double>(std::abs(stability_function(b, static_cast<long double>(w)))), 1e-9)
          << name << ", " << w;
  }
}

TEST(amplification, of_exponential_methods_is_exact_without_transport) {
  const amplification R(find_method("exponential-2"));
  for (const double w : {-1e-3, -0.7, -12.0}) EXPECT_NEAR(largest_factor(R, 0.0, w), std::exp(w), rounding);
}

TEST(amplification, of_bdf_2_is_the_root_of_its_characteristic_polynomial) {
  const amplification R = find_integrator("imex-bdf-2").growth();
  for (const complex z : {complex(-0.2, 0.3), complex(0.0, 0.5)})
    for (const double w : {0.0, -2.0}) {
      // The characteristic polynomial is (3/2 − w) ζ² − (2 + 2z) ζ + (1/2 + z).
      const complex a = 1.5 - w, b = -(2.0 + 2.0 * z), c = 0.5 + z, root = std::sqrt(b * b - 4.0 * a * c);
      EXPECT_NEAR(largest_factor(R, z, w),
                  std::max(std::abs((-b + root) / (2.0 * a)), std::abs((-b - root) / (2.0 * a))), rounding);
    }
}

TEST(amplification, of_imex_dimsim_is_that_of_its_steps) {
  for (const int p : {2, 3}) {
    const auto m = imex_dimsim_coefficients(p).in<double>();
    const amplification R(m);
    for (const complex z : {complex(-0.2, 0.3), complex(0.0, 0.5)})
      for (const double w : {0.0, -2.0, -1e3})
        EXPECT_NEAR(largest_factor(R, z, w), spectral_radius(step_matrix(m, z, w)), 1e-9)
            << p << " " << z << " " << w;
  }
}

TEST(amplification, of_imex_dimsim_is_l_stable) {
  for (const auto& name : integrator_names("imex-dimsim")) {
    const amplification R = find_integrator(name).growth();
    for (double w = -1e-3; w > -1e9; w *= 3.0) EXPECT_TRUE(R.is_within(1.0, 0.0, w)) << name << " " << w;
    // A triple eigenvalue 0 is perturbed by the cube root of rounding, and by λ_Q⁻¹.
    EXPECT_TRUE(R.is_within(1e-3, 0.0, -1e9)) << name;
    EXPECT_TRUE(R.is_within(1.0 + 1e-9, 0.0, 0.0)) << name;
    EXPECT_FALSE(R.is_within(1.0 - 1e-9, 0.0, 0.0)) << name;
  }
}

TEST(amplification, of_two_step_methods_has_the_roots_1_and_minus_b_without_both) {
  for (const auto& name : integrator_names("two-step")) {
    const amplification R = find_integrator(name).growth();
    EXPECT_TRUE(R.is_within(1.0 + 1e-9, 0.0, 0.0)) << name;
    EXPECT_FALSE(R.is_within(1.0 - 1e-9, 0.0, 0.0)) << name;
    // For a method of order p the larger root is exp(z) up to the error of a step.
    const complex z(-0.01, 0.02);
    EXPECT_NEAR(largest_factor(R, z, 0.0), std::exp(-0.01), 1e-6) << name;
  }
}

RC_GTEST_PROP(amplification, counts_the_roots_of_random_polynomials, ()) {
  const int degree = *rc::gen::inRange(1, 7);
  std::vector<complex> c = {*rc::gen::arbitrary<bool>() ? complex(1.0) : complex(-0.3, 2.0)};
  double largest = 0.0;
  for (int k = 0; k < degree; ++k) {
    const complex root = random_in_disc();
    largest = std::max(largest, std::abs(root));
    std::vector<complex> next(c.size() + 1);
    for (std::size_t i = 0; i < c.size(); ++i) {
      next[i + 1] += c[i];
      next[i] -= root * c[i];
    }
    c = next;
  }
  // The rounding error moves a cluster of six equal roots by its sixth root, 2e-3.
  RC_ASSERT(has_roots_within(c, largest + 0.02));
  RC_ASSERT(largest <= 0.02 || !has_roots_within(c, largest - 0.02));
}

}  // namespace amplification_test
