// First and second derivatives of what a design must satisfy, against differences, and its values against the
// order conditions of the Butcher form, which know nothing of Shu–Osher variables.
#include <apsis/core/random_source.hpp>
#include <apsis/design/design_problem.hpp>
#include <apsis/method/intermediate_regime.hpp>
#include <apsis/method/order_conditions.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace apsis {
namespace {

/// A problem with some coefficients left out, and a point inside its bounds.
struct sample {
  design_problem problem;
  Eigen::VectorXd x;
};

sample draw(method_kind kind, int order, std::size_t stages, regime_demand regime, std::uint64_t seed) {
  random_source random(seed);
  std::vector<char> transport(stages, 0);
  for (std::size_t i = 0; i + 1 < stages; ++i) transport[i] = static_cast<char>(i == 0 || !random.one_in(3));
  auto pattern = full_pattern(kind, transport);
  for (std::size_t i = 0; i < stages; ++i) {
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
};

const std::vector<kind_and_order> all = {{method_kind::imex, 1, 2, regime_demand::none},
                                         {method_kind::imex, 2, 3, regime_demand::slow},
                                         {method_kind::imex, 3, 5, regime_demand::all},
                                         {method_kind::imex, 4, 6, regime_demand::none},
                                         {method_kind::implicit_only, 4, 5, regime_demand::none},
                                         {method_kind::implicit_only, 5, 6, regime_demand::none},
                                         {method_kind::explicit_only, 3, 4, regime_demand::none}};

// Central differences with h = 1e-5 of quantities of size 1 with derivatives up to some hundreds: h² times
// third derivatives, and 1e-16/h; 1e-6 of the size of the row holds both.
constexpr double h = 1e-5, near = 1e-6;

TEST(design_derivatives, agree_with_differences) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    auto [problem, x] = draw(all[k].kind, all[k].order, all[k].stages, all[k].regime, k + 1);
    const auto J = problem.jacobian(x);
    Eigen::VectorXd gradient;
    problem.half_square_error(x, &gradient);
    random_source random(17);
    Eigen::VectorXd multipliers(problem.equations());
    for (double& m : multipliers) m = random.uniform(-1.0, 1.0);
    const double weight = 0.7;
    const auto H = problem.hessian(x, multipliers, weight);
    EXPECT_LT((H - H.transpose()).norm(), 1e-12 * H.norm());
    for (Eigen::Index u = 0; u < x.size(); ++u) {
      auto above = x, below = x;
      above(u) += h;
      below(u) -= h;
      const Eigen::VectorXd column = (problem.residuals(above) - problem.residuals(below)) / (2.0 * h);
      EXPECT_LT((column - J.col(u)).norm(), near * (1.0 + J.col(u).norm())) << k << " " << u;
      Eigen::VectorXd g_above, g_below;
      const double difference =
          problem.half_square_error(above, &g_above) - problem.half_square_error(below, &g_below);
      EXPECT_NEAR(difference / (2.0 * h), gradient(u), near * (1.0 + std::abs(gradient(u))));
      const Eigen::VectorXd second = (problem.jacobian(above).transpose() * multipliers + weight * g_above -
                                      problem.jacobian(below).transpose() * multipliers - weight * g_below) /
                                     (2.0 * h);
      EXPECT_LT((second - H.col(u)).norm(), near * (1.0 + H.col(u).norm())) << k << " " << u;
    }
  }
}

TEST(design_conditions, are_those_of_the_butcher_form) {
  for (std::size_t k = 0; k < all.size(); ++k) {
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
          // Both are sums of some hundred products, in another order.
          EXPECT_NEAR(residuals(e), missing, 1e-13 * (1.0 + std::abs(missing)));
        }
    }
    EXPECT_GT(seen, 0);
    EXPECT_NEAR(problem.half_square_error(x), error, 1e-12 * (1.0 + error));
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

int count_of_trees(method_kind kind, int order, std::size_t stages) {
  const std::vector<char> transport(stages, 1);
  const auto list = order_equations(kind, order, stages, transport, transport);
  return static_cast<int>(std::count_if(list.conditions.begin(), list.conditions.end(), [](const auto& c) {
    return c.name.find("stage") == std::string::npos;
  }));
}

TEST(design_conditions, are_fewer_where_abscissae_are_equal) {
  EXPECT_EQ(count_of_trees(method_kind::imex, 2, 3), 6);
  EXPECT_EQ(count_of_trees(method_kind::imex, 3, 6), 15);
  EXPECT_EQ(count_of_trees(method_kind::imex, 4, 14), 49);
  EXPECT_EQ(count_of_trees(method_kind::implicit_only, 5, 9), 17);
}

/// The pattern of a method of the catalogue.
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
    demands.box = 2.0 + 1e-14;  // two coefficients of md-imex-6-3 are 2 to 15 decimals only
    design_problem problem(pattern_of(m, found.kind), demands);
    const auto x = problem.unknowns_of(m);
    EXPECT_LT(problem.residuals(x).lpNorm<Eigen::Infinity>(), 1e-13) << name;
    EXPECT_TRUE((x.array() >= problem.lower().array()).all()) << name;
    EXPECT_TRUE((x.array() <= problem.upper().array()).all()) << name;
  }
}

}  // namespace
}  // namespace apsis
