#include <apsis/method/order_conditions.hpp>
#include <apsis/study/condition_tables.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsis {

std::pair<double, double> compare_with_print(
    const std::vector<rooted_tree>& trees,
    std::vector<printed_condition> (*printed)(const butcher_form<double>&)) {
  double left = 0.0, right = 0.0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto tableau = random_tableau(1 + seed % 6, seed);
    const auto weights = elementary_weights(tableau, trees);
    for (const auto& row : printed(tableau)) {
      const auto found = std::find_if(trees.begin(), trees.end(),
                                      [&](const rooted_tree& tree) { return tree.name == row.tree; });
      if (found == trees.end()) return {std::numeric_limits<double>::quiet_NaN(), right};
      const double value = weights[static_cast<std::size_t>(found - trees.begin())];
      // Sums of at most some hundred products of numbers below 6.
      left = std::max(left, std::abs(value - row.left) / std::max(1.0, std::abs(row.left)));
      right = std::max(right, std::abs(1.0 / found->density - row.right));
    }
  }
  return {left, right};
}

long conditions_of_order(int order, tree_colours colours) {
  const auto trees = rooted_trees(order, colours);
  return std::count_if(trees.begin(), trees.end(),
                       [order](const rooted_tree& t) { return t.order == order; });
}

}  // namespace apsis
