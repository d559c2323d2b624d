#include <apsis/study/condition_tables.hpp>

#include <fmt/format.h>
#include <apsis/study/claim.hpp>

namespace apsis {
namespace {

claim_result check(const study_control&) {
  claim_result result;
  const auto trees = rooted_trees(3, tree_colours::both);
  const auto [values, ratios] = compare_with_print(trees, printed_imex_conditions);
  result.findings = {
      exactly("conditions generated from rooted trees", static_cast<long>(trees.size()), 20),
      exactly("conditions printed", static_cast<long>(printed_imex_conditions(random_tableau(2, 1)).size()),
              20),
      at_most("largest difference between generated and printed left-hand sides, 100 random tableaux of "
              "1 to 6 stages",
              values, 1e-11),
      at_most("largest difference of the right-hand sides", ratios, 1e-15)};
  for (const auto& [order, count] : {std::pair{4, 52L}, std::pair{5, 214L}})
    result.findings.push_back(exactly(fmt::format("beyond the paper: conditions of order {} alone", order),
                                      conditions_of_order(order, tree_colours::both), count));
  return result;
}

}  // namespace

extern const claim_entry claim_C02;
const claim_entry claim_C02 = {
    "C2", "Formulating order conditions",
    "order conditions of multi-derivative IMEX Runge-Kutta methods up to order 3",
    "generated from two-coloured rooted trees and compared with the printed table term by term", check};

}  // namespace apsis
