#include <paper/condition_tables.hpp>

#include <apsis/core/extremes.hpp>
#include <apsis/method/order_conditions.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace apsis::paper {

std::pair<double, double> compare_with_print(const std::vector<rooted_tree>& trees, printed_table printed) {
  double left = 0.0, right = 0.0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto tableau = random_tableau(1 + seed % 6, seed);
    const auto weights = elementary_weights(tableau, trees);
    for (const auto& row : printed(tableau)) {
      const auto found = std::find_if(trees.begin(), trees.end(),
                                      [&](const rooted_tree& tree) { return tree.name == row.tree; });
      if (found == trees.end()) return {std::numeric_limits<double>::quiet_NaN(), right};
      const double value = weights[static_cast<std::size_t>(found - trees.begin())];
      // Each value is a sum of at most some hundred products of numbers below 6.
      left = maximum(left, std::abs(value - row.left) / std::max(1.0, std::abs(row.left)));
      right = maximum(right, std::abs(1.0 / found->density - row.right));
    }
  }
  return {left, right};
}

std::vector<finding> condition_findings(tree_colours colours, printed_table printed, condition_count up_to,
                                        const std::vector<condition_count>& beyond) {
  const auto trees = rooted_trees(up_to.order, colours);
  const auto [values, ratios] = compare_with_print(trees, printed);
  std::vector<finding> findings = {
      exactly("conditions generated from rooted trees", static_cast<long>(trees.size()), up_to.count),
      exactly("conditions printed", static_cast<long>(printed(random_tableau(2, 1)).size()), up_to.count),
      at_most("largest difference between generated and printed left-hand sides, 100 random tableaux of 1 to "
              "6 stages",
              values, 1e-11),
      at_most("largest difference of the right-hand sides", ratios, 1e-15)};
  for (const auto& [order, count] : beyond) {
    const auto more = rooted_trees(order, colours);
    findings.push_back(exactly(
        fmt::format("beyond the paper: conditions of order {} alone", order),
        std::count_if(more.begin(), more.end(), [order](const rooted_tree& t) { return t.order == order; }),
        count));
  }
  return findings;
}

}  // namespace apsis::paper
