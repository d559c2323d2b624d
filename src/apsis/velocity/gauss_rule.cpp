#include <apsis/velocity/gauss_rule.hpp>

#include <apsis/core/errors.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <boost/math/quadrature/gauss.hpp>
#include <fmt/format.h>

namespace apsis {
namespace {

/// Coefficients of the orthonormal polynomials √β_{k+1} p_{k+1} = (x − α_k) p_k − √β_k p_{k−1}.
struct recurrence {
  std::vector<double> alpha, beta;  ///< β_0 is the integral of the weight function
};

/// Computes nodes and weights. With ψ_k = p_k exp(−x²/4) the Christoffel numbers w = 1/Σ ψ_k² are sums of
/// squares. They are accurate to rounding, also where weights from eigenvectors have no correct digit.
gauss_rule rule_of(const recurrence& of) {
  const auto n = of.alpha.size();
  Eigen::VectorXd diagonal(static_cast<Eigen::Index>(n)), beside(static_cast<Eigen::Index>(n) - 1);
  for (std::size_t k = 0; k < n; ++k) {
    diagonal(static_cast<Eigen::Index>(k)) = of.alpha[k];
    if (k > 0) beside(static_cast<Eigen::Index>(k) - 1) = std::sqrt(of.beta[k]);
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> jacobi;
  jacobi.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
  gauss_rule rule;
  for (const double x : jacobi.eigenvalues()) {
    double before = 0.0, here = std::exp(-0.25 * x * x) / std::sqrt(of.beta[0]), sum = here * here;
    for (std::size_t k = 0; k + 1 < n; ++k) {
      const double next = ((x - of.alpha[k]) * here - (k > 0 ? std::sqrt(of.beta[k]) * before : 0.0)) /
                          std::sqrt(of.beta[k + 1]);
      before = here;
      here = next;
      sum += here * here;
    }
    rule.nodes.push_back(x);
    rule.weights.push_back(1.0 / sum);
  }
  return rule;
}

void require(int n, int least, int most) {
  if (n < least || n > most)
    throw input_error(
        fmt::format("velocity.points = {} cannot be used with a Gauss-Hermite set ({} to {} are "
                    "possible); change it",
                    n, least, most));
}

}  // namespace

gauss_rule gauss_hermite(int n) {
  require(n, 4, 300);
  recurrence of;
  for (int k = 0; k < n; ++k) {
    of.alpha.push_back(0.0);
    of.beta.push_back(k == 0 ? std::sqrt(2.0 * std::numbers::pi) : k);
  }
  gauss_rule rule = rule_of(of);
  // Makes the rule symmetric to the last bit.
  for (std::size_t j = 0, last = rule.nodes.size() - 1; j < last - j; ++j) {
    rule.nodes[j] = -rule.nodes[last - j];
    rule.weights[j] = rule.weights[last - j];
  }
  if (n % 2 == 1) rule.nodes[static_cast<std::size_t>(n / 2)] = 0.0;
  return rule;
}

gauss_rule half_range_gauss_hermite(int n) {
  require(n, 2, 60);
  // Stieltjes' procedure. Its sums run over a composite rule that is fine enough to give integrals
  // to rounding.
  using rule = boost::math::quadrature::gauss<long double, 30>;
  std::vector<long double> x, w;
  const long double end = 2.5L * std::sqrt(4.0L * n + 40.0L);
  constexpr int parts = 60;
  for (int part = 0; part < parts; ++part)
    for (std::size_t q = 0; q < rule::abscissa().size(); ++q)
      for (const long double side : {-1.0L, 1.0L}) {
        const long double half = 0.5L * end / parts;
        x.push_back((2 * part + 1) * half + side * half * rule::abscissa()[q]);
        w.push_back(half * rule::weights()[q] * std::exp(-0.5L * x.back() * x.back()));
      }
  recurrence of;
  std::vector<long double> before(x.size()), here(x.size(), 1.0L);
  long double norm_before = 1.0L;
  for (int k = 0; k < n; ++k) {
    long double norm = 0.0L, first = 0.0L;
    for (std::size_t i = 0; i < x.size(); ++i) {
      norm += w[i] * here[i] * here[i];
      first += w[i] * x[i] * here[i] * here[i];
    }
    const long double alpha = first / norm, beta = k == 0 ? norm : norm / norm_before;
    of.alpha.push_back(static_cast<double>(alpha));
    of.beta.push_back(static_cast<double>(beta));
    for (std::size_t i = 0; i < x.size(); ++i) {
      const long double next = (x[i] - alpha) * here[i] - (k > 0 ? beta * before[i] : 0.0L);
      before[i] = here[i];
      here[i] = next;
    }
    norm_before = norm;
  }
  return rule_of(of);
}

}  // namespace apsis
