// First and second derivatives of design problems agree with finite differences. Their values agree with the
// order conditions of the Butcher form, which do not involve Shu–Osher variables.
#include <apsis/core/random_source.hpp>
#include <apsis/design/design_problem.hpp>
#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/kinds/two_step.hpp>
#include <apsis/method/order_conditions.hpp>
#include <apsis/method/stability.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace apsis::derivatives_test {
namespace {

using measure = design_problem::measure;

/// Demanded angle of A(α)-stability in degrees. The ray avoids the imaginary axis, where stages with d = 0
/// have poles.
constexpr double demanded_angle = 60.0;

/// A problem with a random zero pattern, and a point inside its bounds.
struct sample {
  design_problem problem;
  Eigen::VectorXd x;
};

sample draw(method_kind kind, int order, std::size_t stages, regime_demand regime, std::uint64_t seed,
            int steps = 1) {
  random_source random(seed);
  std::vector<char> transport(stages, 0);
  for (std::size_t i = 0; i + 1 < stages; ++i) transport[i] = static_cast<char>(i == 0 || !random.one_in(3));
  auto pattern = full_pattern(kind, transport, steps);
  for (auto i = static_cast<std::size_t>(steps) - 1; i < stages; ++i) {
    if (i + 1 == stages || random.one_in(2)) {
      pattern.ddot[i] = 0;
    } else if (random.one_in(3)) {
      pattern.d[i] = 0;
    }
    for (std::size_t j = 0; j < i; ++j) pattern.P(i, j) = static_cast<char>(!random.one_in(3));
  }
  design_demands demands;
  demands.order = order;
  demands.regime = regime;
  if (steps == 1) demands.least_angle = demanded_angle;
  design_problem problem(pattern, demands);
  Eigen::VectorXd x(problem.unknowns());
  for (Eigen::Index k = 0; k < x.size(); ++k)
    x(k) = random.uniform(0.1, 0.4) * (problem.lower()(k) < 0.0 ? -1.0 : 1.0);
  return {std::move(problem), x};
}

struct kind_and_order {
  method_kind kind;
  int order;
  std::size_t stages;
  regime_demand regime;
  int steps = 1;
};

const std::vector<kind_and_order> all = {{method_kind::imex, 1, 2, regime_demand::none},
                                         {method_kind::imex, 2, 3, regime_demand::slow},
                                         {method_kind::imex, 3, 5, regime_demand::all},
                                         {method_kind::imex, 4, 6, regime_demand::none},
                                         {method_kind::implicit_only, 4, 5, regime_demand::none},
                                         {method_kind::implicit_only, 5, 6, regime_demand::none},
                                         {method_kind::explicit_only, 3, 4, regime_demand::none},
                                         {method_kind::imex, 3, 6, regime_demand::slow, 2},
                                         {method_kind::imex, 4, 7, regime_demand::none, 2}};

// Central differences with h = 1e-5. The quantities have size 1, their derivatives up to some hundreds. The
// tolerance 1e-6 is relative to the size of the row. It covers h² times third derivatives and 1e-16/h.
constexpr double h = 1e-5, tolerance = 1e-6;

Eigen::VectorXd draw_vector(Eigen::Index size, random_source& random) {
  Eigen::VectorXd v(size);
  for (double& entry : v) entry = random.uniform(-1.0, 1.0);
  return v;
}

/// Returns the gradient of Σ λ residual + Σ μ limit + the weighted half squares.
Eigen::VectorXd gradient_of_sum(design_problem& problem, const Eigen::VectorXd& x,
                                const design_problem::weights& given) {
  Eigen::VectorXd g = problem.jacobian(x).transpose() * given.equations, part;
  g += problem.limit_jacobian(x).transpose() * given.limits;
  for (const auto& [what, weight] :
       {std::pair{measure::error, given.error}, {measure::band, given.band}, {measure::layer, given.layer}}) {
    if (weight == 0.0) continue;
    problem.half_square(what, x, &part);
    g += weight * part;
  }
  return g;
}

TEST(design_derivatives, agree_with_differences) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    auto [problem, x] = draw(all[k].kind, all[k].order, all[k].stages, all[k].regime, k + 1, all[k].steps);
    const bool transports = all[k].kind != method_kind::implicit_only;
    const auto J = problem.jacobian(x), limit_J = problem.limit_jacobian(x);
    EXPECT_EQ(problem.limits() > 0, all[k].kind != method_kind::explicit_only && all[k].steps == 1);
    Eigen::VectorXd of_error, of_band, of_layer;
    problem.half_square(measure::error, x, &of_error);
    if (transports) {
      problem.half_square(measure::band, x, &of_band);
      problem.half_square(measure::layer, x, &of_layer);
    }
    random_source random(17);
    design_problem::weights given;
    given.equations = draw_vector(problem.equations(), random);
    given.limits = draw_vector(problem.limits(), random);
    given.error = 0.7;
    given.band = transports ? 0.4 : 0.0;
    given.layer = transports ? 0.3 : 0.0;
    const auto H = problem.hessian(x, given);
    EXPECT_LT((H - H.transpose()).norm(), 1e-12 * H.norm());
    for (Eigen::Index u = 0; u < x.size(); ++u) {
      auto above = x, below = x;
      above(u) += h;
      below(u) -= h;
      const auto expect_slope = [&](const auto& quantity, const Eigen::VectorXd& slope) {
        const Eigen::VectorXd column = (quantity(above) - quantity(below)) / (2.0 * h);
        EXPECT_LT((column - slope).norm(), tolerance * (1.0 + slope.norm())) << k << " " << u;
      };
      expect_slope([&](const auto& y) { return problem.residuals(y); }, J.col(u));
      if (problem.limits() > 0) {
        expect_slope([&](const auto& y) { return problem.limit_values(y); }, limit_J.col(u));
      }
      const auto square = [&](measure what) {
        return [&problem, what](const Eigen::VectorXd& y) {
          return Eigen::VectorXd::Constant(1, problem.half_square(what, y)).eval();
        };
      };
      expect_slope(square(measure::error), of_error.segment(u, 1));
      if (transports) {
        expect_slope(square(measure::band), of_band.segment(u, 1));
        expect_slope(square(measure::layer), of_layer.segment(u, 1));
      }
      expect_slope([&](const auto& y) { return gradient_of_sum(problem, y, given); }, H.col(u));
    }
  }
}

/// Returns the Butcher form in long double for the formulas of the certificate.
butcher_form<long double> butcher_of(const shu_osher_form<double>& m) {
  const auto b = to_butcher(m);
  const auto wide = [](const matrix<double>& from) {
    matrix<long double> to(from.rows(), from.cols());
    for (std::size_t i = 0; i < from.rows(); ++i)
      for (std::size_t j = 0; j < from.cols(); ++j) to(i, j) = from(i, j);
    return to;
  };
  return {wide(b.A_hat), wide(b.A), wide(b.A_dot)};
}

// Do residuals of the band and stability limits agree with flux(z) and R(ζ) of the certificate? Both solve
// triangular systems. They differ by rounding errors times the size of the terms.
TEST(design_conditions, agree_with_flux_and_stability_function_of_the_certificate) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].kind == method_kind::explicit_only || all[k].steps == 2) continue;
    auto [problem, x] = draw(all[k].kind, all[k].order, all[k].stages, all[k].regime, 200 + k);
    const auto butcher = butcher_of(problem.form(x));
    const auto limits = problem.limit_values(x);
    ASSERT_EQ(limits.size(), 85);  // 24 per decade from 10^-1 to 10^2.5
    for (Eigen::Index l = 0; l < limits.size(); ++l) {
      const long double radius = std::pow(10.0L, -1.0L + static_cast<long double>(l) / 24.0L);
      const long double angle = problem.demands().aimed_angle() * std::numbers::pi_v<long double> / 180.0L;
      const auto R = stability_function(butcher, -std::polar(radius, -angle));
      const auto expected = static_cast<double>((std::norm(R) - 1) / std::pow(std::min(1.0L, radius), 4.0L));
      EXPECT_NEAR(limits(l), expected, 1e-11 * (1.0 + std::abs(expected))) << k << " " << l;
    }
    if (all[k].kind == method_kind::implicit_only) continue;
    double sum = 0.0, layer = 0.0;
    for (int l = -8; l <= 20; ++l) {  // 8 per decade
      const long double z = std::pow(10.0L, l / 8.0L);
      const long double R = stability_function(butcher, -z).real();
      const long double residual = (at_finite_rate(butcher, z).flux - 1) / z * (1 - R) / -std::expm1(-z);
      sum += static_cast<double>(residual * residual) / 8.0;
      const long double of_layer = at_finite_rate(butcher, z).layer - (1 - R) / z;
      const long double deviation = (at_finite_rate(butcher, z).last - 1) / z * (1 - R) / -std::expm1(-z);
      layer += static_cast<double>(of_layer * of_layer + deviation * deviation) / 8.0;
    }
    EXPECT_NEAR(problem.half_square(measure::layer, x), 0.5 * layer, 1e-11 * (1.0 + layer)) << k;
    EXPECT_NEAR(problem.half_square(measure::band, x), 0.5 * sum, 1e-11 * (1.0 + sum)) << k;
  }
}

TEST(design_conditions, agree_with_the_butcher_form) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].steps == 2) continue;
    auto [problem, x] = draw(all[k].kind, all[k].order, all[k].stages, all[k].regime, 100 + k);
    const auto m = problem.form(x);
    const auto butcher = to_butcher(m);
    const auto trees =
        rooted_trees(all[k].order + 1, all[k].kind == method_kind::imex            ? tree_colours::both
                                       : all[k].kind == method_kind::implicit_only ? tree_colours::G_only
                                                                                   : tree_colours::F_only);
    const auto weights = elementary_weights(butcher, trees);
    const auto residuals = problem.residuals(x);
    double error = 0.0;
    int seen = 0;
    for (std::size_t t = 0; t < trees.size(); ++t) {
      const double missing = weights[t] - 1.0 / trees[t].density;
      if (trees[t].order > all[k].order) error += 0.5 * missing * missing;
      for (Eigen::Index e = 0; e < problem.equations(); ++e)
        if (problem.equation_name(e) == trees[t].name) {
          ++seen;
          // Both values are sums of several hundred products in different order.
          EXPECT_NEAR(residuals(e), missing, 1e-13 * (1.0 + std::abs(missing)));
        }
    }
    EXPECT_GT(seen, 0);
    EXPECT_NEAR(problem.half_square(measure::error, x), error, 1e-12 * (1.0 + error));
    if (all[k].regime == regime_demand::none) continue;
    const auto terms = analyse_intermediate_regime(m);
    for (Eigen::Index e = 0; e < problem.equations(); ++e) {
      const auto expect = [&](const std::string& name, double value) {
        if (problem.equation_name(e) == name) {
          EXPECT_NEAR(residuals(e), value - 1.0, 1e-12);
        }
      };
      expect("flux = 1", terms.flux);
      expect("last = 1", terms.last);
      expect("layer = 1", terms.layer);
    }
  }
}

// The same comparison for two-step methods, with the tolerances above. Their certificate solves the rows one
// by one, without nodes.
TEST(design_conditions, agree_with_the_certificate_of_two_step_methods) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].steps == 1) continue;
    auto [problem, x] = draw(all[k].kind, all[k].order, all[k].stages, all[k].regime, 300 + k, 2);
    const auto m = problem.form(x);
    const auto trees = rooted_trees(all[k].order, tree_colours::both);
    const auto weights = two_step_weights(m, trees);
    const auto residuals = problem.residuals(x);
    int seen = 0;
    for (std::size_t t = 0; t < trees.size(); ++t)
      for (Eigen::Index e = 0; e < problem.equations(); ++e)
        if (problem.equation_name(e) == trees[t].name) {
          ++seen;
          const double missing = weights[t] - 1.0 / trees[t].density;
          EXPECT_NEAR(residuals(e), missing, 1e-13 * (1.0 + std::abs(missing))) << trees[t].name;
        }
    EXPECT_GE(seen, 15);
    const auto leaf = static_cast<std::size_t>(
        std::find_if(trees.begin(), trees.end(), [](const rooted_tree& t) { return t.name == "F"; }) -
        trees.begin());
    double sum = 0.0;
    for (int l = -8; l <= 20; ++l) {  // 8 per decade
      const double z = std::pow(10.0, l / 8.0);
      double decay = 1.0;  // of a deviation that u^{n-1} and u^n share
      {
        const auto initial = initial_weights(m);
        std::vector<double> y(m.stages(), 1.0);
        for (std::size_t i = 1; i < y.size(); ++i) {
          y[i] = initial[i];
          for (std::size_t j = 0; j < i; ++j) y[i] += (m.P(i, j) + m.W(i, j)) * y[j];
          y[i] /= 1.0 + z * (m.D(i, i) - z * m.ddot[i]);
        }
        decay = y.back();
      }
      // Σ b̂ equals 1 + b only if the method has order 1. These random methods do not.
      const double b = weight_of_previous(m), sum_of_b_hat = weights[leaf] + b;
      const double flux = two_step_at_finite_rate(m, z).flux * (1.0 + b);
      const double residual = (flux - sum_of_b_hat) / z * (1.0 - decay) / -std::expm1(-z);
      sum += residual * residual / 8.0;
    }
    EXPECT_NEAR(problem.half_square(measure::band, x), 0.5 * sum, 1e-11 * (1.0 + sum)) << k;
  }
}

int count_of_trees(method_kind kind, int order, std::size_t stages) {
  const std::vector<char> transport(stages, 1);
  const auto list = order_equations(kind, order, stages, transport, transport);
  return static_cast<int>(std::count_if(list.conditions.begin(), list.conditions.end(), [](const auto& c) {
    return c.name.find("stage") == std::string::npos;
  }));
}

TEST(design_conditions, are_fewer_if_abscissae_are_equal) {
  EXPECT_EQ(count_of_trees(method_kind::imex, 2, 3), 6);
  EXPECT_EQ(count_of_trees(method_kind::imex, 3, 6), 15);
  EXPECT_EQ(count_of_trees(method_kind::imex, 4, 14), 49);
  EXPECT_EQ(count_of_trees(method_kind::implicit_only, 5, 9), 17);
}

/// Returns the zero pattern of a method of the catalogue.
zero_pattern pattern_of(const shu_osher_form<double>& m, method_kind kind) {
  zero_pattern p = full_pattern(kind, std::vector<char>(m.stages(), 1));
  for (std::size_t i = 0; i < m.stages(); ++i) {
    p.d[i] = static_cast<char>(m.D(i, i) != 0.0);
    p.ddot[i] = static_cast<char>(m.ddot[i] != 0.0);
    for (std::size_t j = 0; j < i; ++j) {
      p.P(i, j) = static_cast<char>(m.P(i, j) != 0.0);
      p.W(i, j) = static_cast<char>(m.W(i, j) != 0.0);
    }
  }
  return p;
}

TEST(design_conditions, hold_for_the_catalogue) {
  for (const auto& [name, regime] : {std::pair{"md-imex-3-2", regime_demand::none},
                                     {"md-imex-5-2", regime_demand::all},
                                     {"md-imex-6-3", regime_demand::none},
                                     {"md-imex-8-3", regime_demand::all},
                                     {"imdrk-5-4", regime_demand::none},
                                     {"imdrk-9-5", regime_demand::none}}) {
    const method& found = find_method(name);
    const auto m = found.coefficients<double>();
    design_demands demands;
    demands.order = found.claims.order;
    demands.regime = regime;
    demands.box = 2.0 + 1e-14;  // two coefficients of md-imex-6-3 are 2 only up to 15 decimals
    design_problem problem(pattern_of(m, found.kind), demands);
    const auto x = problem.unknowns_of(m);
    EXPECT_LT(problem.residuals(x).lpNorm<Eigen::Infinity>(), 1e-13) << name;
    EXPECT_TRUE((x.array() >= problem.lower().array()).all()) << name;
    EXPECT_TRUE((x.array() <= problem.upper().array()).all()) << name;
  }
}

}  // namespace
}  // namespace apsis::derivatives_test
