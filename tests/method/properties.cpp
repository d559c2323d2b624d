// Properties of trees, order conditions and conversions for random input. Methods of the literature have
// their known orders.
#include "tableaux.hpp"

#include <apsis/method/order_conditions.hpp>
#include <apsis/method/trees.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <support/property.hpp>

namespace apsis::test::properties_test {
namespace {

TEST(trees, have_the_known_number_per_order) {
  // The numbers of rooted trees with one colour are 1, 1, 2, 4, 9, 20, 48 (OEIS A000081). Those with two
  // colours are A000151.
  const std::vector<std::size_t> one = {1, 1, 2, 4, 9, 20, 48}, two = {2, 4, 14, 52, 214, 916};
  for (const auto& [colours, numbers_of] :
       {std::pair{tree_colours::G_only, one}, std::pair{tree_colours::F_only, one},
        std::pair{tree_colours::both, two}}) {
    const auto trees = rooted_trees(static_cast<int>(numbers_of.size()), colours);
    std::set<std::string> names;
    std::vector<std::size_t> counted(numbers_of.size(), 0);
    for (const auto& tree : trees) {
      names.insert(tree.name);
      ++counted[static_cast<std::size_t>(tree.order) - 1];
    }
    EXPECT_EQ(names.size(), trees.size());
    EXPECT_EQ(counted, numbers_of);
  }
}

struct measured {
  double order = 1, density = 1;
};

/// Returns the order and density of a tree from the brackets of its name.
measured measure(const std::string& name, std::size_t& at) {
  measured tree;
  ++at;
  if (at < name.size() && name[at] == '[') {
    do {
      ++at;
      const measured child = measure(name, at);
      tree.order += child.order;
      tree.density *= child.density;
    } while (name[at] == ',');
    ++at;
  }
  tree.density *= tree.order;
  return tree;
}

TEST(trees, have_the_order_and_density_of_their_names) {
  for (const auto& tree : rooted_trees(6, tree_colours::both)) {
    std::size_t at = 0;
    const auto read = measure(tree.name, at);
    EXPECT_EQ(at, tree.name.size()) << tree.name;
    EXPECT_EQ(read.order, tree.order) << tree.name;
    EXPECT_EQ(read.density, tree.density) << tree.name;
  }
}

TEST(trees, have_densities_between_those_of_the_bush_and_the_tall_tree) {
  // Among the trees of order n, the tall tree has the largest density, γ = n!. The bush has the smallest,
  // γ = n.
  double factorial = 1;
  for (int n = 1; n <= 6; ++n) {
    factorial *= n;
    double largest = 0, smallest = 1e9;
    for (const auto& tree : rooted_trees(n, tree_colours::G_only)) {
      if (tree.order != n) continue;
      largest = std::max(largest, tree.density);
      smallest = std::min(smallest, tree.density);
    }
    EXPECT_EQ(largest, factorial);
    EXPECT_EQ(smallest, n);
  }
}

int order_of(const butcher_form<double>& b, tree_colours colours) {
  const auto trees = rooted_trees(6, colours);
  const auto weights = elementary_weights(b, trees);
  int first_failing = 7;
  for (std::size_t k = 0; k < trees.size(); ++k)
    if (std::abs(weights[k] - 1 / trees[k].density) > 1e-13)
      first_failing = std::min(first_failing, trees[k].order);
  return first_failing - 1;
}

butcher_form<double> tableau(std::size_t s) {
  return {matrix<double>(s, s), matrix<double>(s, s), matrix<double>(s, s)};
}

void set(matrix<double>& m, const std::vector<numbers>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < rows[i].size(); ++j) m(i, j) = rows[i][j];
}

TEST(order, of_methods_of_the_literature_is_the_known_one) {
  auto kutta = tableau(5);
  set(kutta.A_hat, {{}, {0.5}, {0, 0.5}, {0, 0, 1}, {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6}});
  kutta.A = kutta.A_hat;
  EXPECT_EQ(order_of(kutta, tree_colours::F_only), 4);
  EXPECT_EQ(order_of(kutta, tree_colours::both), 4);  // the same tableau for both operators

  auto dormand_prince = tableau(7);
  set(dormand_prince.A_hat, {{},
                             {1.0 / 5},
                             {3.0 / 40, 9.0 / 40},
                             {44.0 / 45, -56.0 / 15, 32.0 / 9},
                             {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                             {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                             {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}});
  EXPECT_EQ(order_of(dormand_prince, tree_colours::F_only), 5);

  // These two-derivative methods have one and two internal stages (Chan and Tsai, Numer.
  // Algorithms 53, 2010).
  auto fourth = tableau(3);
  set(fourth.A, {{}, {0.5}, {1}});
  set(fourth.A_dot, {{}, {1.0 / 8}, {1.0 / 6, 1.0 / 3}});
  EXPECT_EQ(order_of(fourth, tree_colours::G_only), 4);
  auto fifth = tableau(4);
  set(fifth.A, {{}, {2.0 / 5}, {1}, {1}});
  set(fifth.A_dot, {{}, {2.0 / 25}, {-1.0 / 4, 3.0 / 4}, {1.0 / 8, 25.0 / 72, 1.0 / 36}});
  EXPECT_EQ(order_of(fifth, tree_colours::G_only), 5);
}

TEST(order_conditions, scale_with_the_step_length) {
  check_property("steps of length λ: (λÂ, λA, λ²Ȧ) has λ^|τ| times the weights", [] {
    const auto s = *rc::gen::inRange<std::size_t>(1, 6);
    const double lambda = *rc::gen::inRange(1, 40) / 16.0;
    const auto b = random_tableau(s, *rc::gen::arbitrary<std::uint32_t>());
    auto scaled = b;
    for (std::size_t i = 0; i < s; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        scaled.A_hat(i, j) *= lambda;
        scaled.A(i, j) *= lambda;
        scaled.A_dot(i, j) *= lambda * lambda;
      }
    const auto trees = rooted_trees(5, tree_colours::both);
    const auto before = elementary_weights(b, trees), after = elementary_weights(scaled, trees);
    for (std::size_t k = 0; k < trees.size(); ++k) {
      const double wanted = std::pow(lambda, trees[k].order) * before[k];
      // Sums of up to 5⁵ products of numbers below 2.5⁵ may cancel, so the bound is absolute.
      RC_ASSERT(std::abs(after[k] - wanted) <= 1e-10 * std::pow(1 + lambda, 5) * 100);
    }
  });
}

TEST(order_conditions, do_not_depend_on_colours_if_both_tableaux_are_equal) {
  check_property("Â = A, Ȧ = 0: a tree and its one-coloured twin have equal weights", [] {
    auto b = random_tableau(*rc::gen::inRange<std::size_t>(1, 7), *rc::gen::arbitrary<std::uint32_t>());
    b.A = b.A_hat;
    b.A_dot = matrix<double>(b.stages(), b.stages());
    const auto trees = rooted_trees(4, tree_colours::both);
    const auto weights = elementary_weights(b, trees);
    std::map<double, std::map<std::string, double>> seen;
    for (std::size_t k = 0; k < trees.size(); ++k) {
      std::string bare = trees[k].name;
      std::replace(bare.begin(), bare.end(), 'F', 'G');
      const auto [place, fresh] = seen[trees[k].density].emplace(bare, weights[k]);
      // Twins may list children in a different order. They are then compared with each other.
      if (!fresh) RC_ASSERT(std::abs(place->second - weights[k]) < 1e-11);
    }
  });
}

TEST(conversion, to_butcher_and_back_is_the_identity) {
  check_property("to_shu_osher(to_butcher(m), I − P − W, r) = m", [] {
    const auto s = *rc::gen::inRange<std::size_t>(1, 9);
    noise draw(*rc::gen::arbitrary<std::uint32_t>());
    shu_osher_form<mp_real> m;
    m.P = m.W = m.D = matrix<mp_real>(s, s);
    m.r = 1 + draw() / 2;
    auto R = matrix<mp_real>::identity(s);
    for (std::size_t i = 0; i < s; ++i) {
      m.ddot.emplace_back(-std::abs(draw()));
      for (std::size_t j = 0; j <= i; ++j) m.D(i, j) = draw();
      for (std::size_t j = 0; j < i; ++j) {
        m.P(i, j) = draw();
        m.W(i, j) = draw();
        R(i, j) = -m.P(i, j) - m.W(i, j);
      }
    }
    const auto again = to_shu_osher(to_butcher(m), R, m.r);
    for (std::size_t i = 0; i < s; ++i) {
      // The numbers have 60 digits. The inverse of R loses a few of them.
      RC_ASSERT(abs(again.ddot[i] - m.ddot[i]) < mp_real(1e-50));
      for (std::size_t j = 0; j <= i; ++j) {
        RC_ASSERT(abs(again.P(i, j) - m.P(i, j)) < mp_real(1e-50));
        RC_ASSERT(abs(again.W(i, j) - m.W(i, j)) < mp_real(1e-50));
        RC_ASSERT(abs(again.D(i, j) - m.D(i, j)) < mp_real(1e-50));
      }
    }
  });
}

TEST(conversion, agrees_with_the_recursion_over_stages) {
  check_property("y' = αy + βy solved stage by stage equals the Butcher form", [] {
    const auto s = *rc::gen::inRange<std::size_t>(1, 7);
    noise draw(*rc::gen::arbitrary<std::uint32_t>());
    shu_osher_form<double> m;
    m.P = m.W = m.D = matrix<double>(s, s);
    m.r = 1.25;
    for (std::size_t i = 0; i < s; ++i) {
      m.ddot.push_back(-std::abs(draw()));
      m.D(i, i) = std::abs(draw());
      for (std::size_t j = 0; j < i; ++j) {
        m.P(i, j) = draw() / 2;
        m.W(i, j) = draw() / 2;
      }
    }
    const double alpha = draw(), beta = -std::abs(draw());  // T = αu, Q = βu, Q̇ = β²u, Δt = 1
    const auto initial = initial_weights(m);
    const auto b = to_butcher(m);
    numbers u;
    for (std::size_t i = 0; i < s; ++i) {
      double known = initial[i], increments = 1;
      for (std::size_t j = 0; j < i; ++j) {
        known += m.P(i, j) * u[j] + m.W(i, j) * (u[j] + alpha * u[j] / m.r);
        increments += (alpha * b.A_hat(i, j) + beta * b.A(i, j) + beta * beta * b.A_dot(i, j)) * u[j];
      }
      u.push_back(known / (1 - beta * m.D(i, i) - beta * beta * m.ddot[i]));
      increments += (beta * b.A(i, i) + beta * beta * b.A_dot(i, i)) * u[i];
      // Entries of R⁻¹ stay below 2⁶.
      RC_ASSERT(std::abs(u[i] - increments) < 1e-11);
    }
  });
}

}  // namespace
}  // namespace apsis::test::properties_test
