#include <apsis/study/condition_tables.hpp>

#include <fmt/format.h>
#include <apsis/study/claim.hpp>

namespace apsis {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  const auto trees = rooted_trees(4, tree_colours::G_only);
  const auto [values, ratios] = compare_with_print(trees, printed_implicit_conditions);
  result.findings = {
      exactly("conditions generated from rooted trees", static_cast<long>(trees.size()), 8),
      exactly("conditions printed",
              static_cast<long>(printed_implicit_conditions(random_tableau(2, 1)).size()), 8),
      at_most("largest difference between generated and printed left-hand sides, 100 random tableaux of "
              "1 to 6 stages",
              values, 1e-11),
      at_most("largest difference of the right-hand sides", ratios, 1e-15)};
  for (const auto& [order, count] : {std::pair{5, 9L}, std::pair{6, 20L}})
    result.findings.push_back(exactly(fmt::format("beyond the paper: conditions of order {} alone", order),
                                      conditions_of_order(order, tree_colours::G_only), count));
  return result;
}

}  // namespace

extern const claim_entry claim_C01;
const claim_entry claim_C01 = {
    "C1", "Formulating the order conditions",
    "order conditions of implicit two-derivative Runge-Kutta methods up to order 4",
    "generated from rooted trees and compared with the printed table term by term", check};

}  // namespace apsis
