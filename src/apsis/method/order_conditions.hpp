#pragma once

#include <apsis/method/tableau.hpp>
#include <apsis/method/trees.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// Computes the left-hand sides of the order conditions, one for each tree of the list: the last entry of
/// the stage vector
///   root F:  φ(τ) = Â Π_k φ(τ_k)
///   root G:  φ(τ) = A Π_k φ(τ_k) + Ȧ Σ_{k: root(τ_k) = G} (Π_{l≠k} φ(τ_l)) (Π_{σ child of τ_k} φ(σ))
/// Products are componentwise; an empty one is (1, …, 1). The second term follows from Ġ = G'G by the product
/// rule. The method has order p if the values equal 1/γ(τ) for all trees with at most p nodes.
template <class Real>
std::vector<Real> elementary_weights(const butcher_form<Real>& method, const std::vector<rooted_tree>& trees);

/// Trees of one order, and the left-hand sides of their conditions for one or two results.
template <class Real>
struct order_level {
  std::vector<rooted_tree> trees;          ///< of this order alone; children count from the first tree of all
  std::vector<std::vector<Real>> weights;  ///< one vector for each result, one number for each tree
};

/// Evaluates the order conditions order by order. Subtrees are evaluated once for all orders and results:
/// u^{n+1} and an embedded solution have the same stages. The values are those of elementary_weights().
template <class Real>
class order_levels {
 public:
  /// The results are the last rows of the form, one or two.
  order_levels(butcher_form<Real> method, tree_colours colours, std::size_t results);
  order_levels(const order_levels&) = delete;
  order_levels& operator=(const order_levels&) = delete;
  ~order_levels();

  /// Returns the conditions of an order ≥ 1. They are evaluated at the first call.
  const order_level<Real>& at(int order);

 private:
  struct parts;
  std::unique_ptr<parts> parts_;
};

}  // namespace apsis
