#pragma once

#include <apsis/method/tableau.hpp>
#include <apsis/method/trees.hpp>

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

}  // namespace apsis
