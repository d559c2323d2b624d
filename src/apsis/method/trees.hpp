#pragma once

#include <string>
#include <vector>

namespace apsis {

/// Colour of a node: F for the explicit operator T, G for the implicit operator Q.
enum class colour { F, G };

/// A rooted tree with coloured nodes. Children are sorted indices into the list that contains the tree; equal
/// subtrees are repeated.
struct rooted_tree {
  colour root = colour::F;    ///< colour of the root
  std::vector<int> children;  ///< τ_1 … τ_m of τ = [τ_1 … τ_m]
  int order = 1;              ///< number of nodes
  double density = 1.0;       ///< γ(τ) = |τ| Π γ(τ_k), an integer
  std::string name;           ///< "G[F,G[F]]"
};

/// Node colours of a list of trees.
enum class tree_colours { F_only, G_only, both };

/// Returns every tree of order 1 … `order`, sorted by order, children before their parents. Numbers of trees
/// per order: 2, 4, 14, 52, 214, … with two colours; 1, 1, 2, 4, 9, … with one.
std::vector<rooted_tree> rooted_trees(int order, tree_colours colours);

}  // namespace apsis
