#pragma once

#include <apsis/method/trees.hpp>

#include <utility>
#include <vector>

#include <paper/claim.hpp>
#include <paper/paper_tables.hpp>

namespace apsis::paper {

/// A printed table of order conditions, evaluated on a tableau.
using printed_table = std::vector<printed_condition> (*)(const butcher_form<double>&);

/// Returns the largest differences between the generated conditions and those of a printed table. The first
/// one is that of the left-hand sides, relative, on 100 random tableaux; NaN if a printed tree is not
/// generated. The second one is that of the right-hand sides.
std::pair<double, double> compare_with_print(const std::vector<rooted_tree>& trees, printed_table printed);

/// Number of conditions (or trees) of one order.
struct condition_count {
  int order;   ///< number of nodes of the trees
  long count;  ///< number of conditions
};

/// Returns the findings that the trees up to `up_to.order` agree with the printed table, `up_to.count`
/// conditions, term by term. Further findings are the numbers of conditions of the orders in `beyond`.
std::vector<finding> condition_findings(tree_colours colours, printed_table printed, condition_count up_to,
                                        const std::vector<condition_count>& beyond);

}  // namespace apsis::paper
