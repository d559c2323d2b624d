#pragma once

#include <apsis/method/trees.hpp>

#include <utility>
#include <vector>

#include <paper/claim.hpp>
#include <paper/paper_tables.hpp>

namespace apsis::paper {

/// A printed table of order conditions, evaluated on a tableau.
using printed_table = std::vector<printed_condition> (*)(const butcher_form<double>&);

/// Largest differences of the left-hand sides (relative, on 100 random tableaux) and right-hand sides between
/// the generated conditions and those of a printed table; NaN if a printed tree is not generated.
std::pair<double, double> compare_with_print(const std::vector<rooted_tree>& trees, printed_table printed);

/// Number of conditions (or trees) of one order.
struct condition_count {
  int order;   ///< number of nodes of the trees
  long count;  ///< number of them
};

/// Findings that the trees up to `up_to.order` are the printed table, `up_to.count` conditions, term by term;
/// and the numbers of conditions of the orders beyond.
std::vector<finding> condition_findings(tree_colours colours, printed_table printed, condition_count up_to,
                                        const std::vector<condition_count>& beyond);

}  // namespace apsis::paper
