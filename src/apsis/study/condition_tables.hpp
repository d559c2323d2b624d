#pragma once

#include <apsis/method/trees.hpp>
#include <apsis/study/paper_tables.hpp>

#include <utility>
#include <vector>

namespace apsis {

/// Largest differences of the left-hand sides (relative, on 100 random tableaux) and right-hand sides between
/// the conditions generated from trees and those of a printed table; NaN if a printed tree is not generated.
std::pair<double, double> compare_with_print(
    const std::vector<rooted_tree>& trees,
    std::vector<printed_condition> (*printed)(const butcher_form<double>&));

/// Number of trees with exactly `order` nodes.
long conditions_of_order(int order, tree_colours colours);

}  // namespace apsis
