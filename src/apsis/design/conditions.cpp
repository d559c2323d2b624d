#include <apsis/design/conditions.hpp>

#include <apsis/method/trees.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace apsis {
namespace {

tree_colours colours_of(method_kind kind) {
  switch (kind) {
    case method_kind::implicit_only:
      return tree_colours::G_only;
    case method_kind::explicit_only:
      return tree_colours::F_only;
    case method_kind::imex:
      break;
  }
  return tree_colours::both;
}

bool is_leaf(const rooted_tree& tree, colour root) {
  return tree.children.empty() && tree.root == root;
}

/// Whether some node T has a leaf Q, for which a leaf T gives the same weight where c = ĉ.
bool repeats_another(std::size_t tree, const std::vector<rooted_tree>& trees) {
  return std::any_of(trees[tree].children.begin(), trees[tree].children.end(), [&](int child) {
    const auto c = static_cast<std::size_t>(child);
    return (trees[tree].root == colour::F && is_leaf(trees[c], colour::G)) || repeats_another(c, trees);
  });
}

int index_of(const std::vector<rooted_tree>& trees, const std::string& name) {
  const auto found =
      std::find_if(trees.begin(), trees.end(), [&](const rooted_tree& t) { return t.name == name; });
  return static_cast<int>(found - trees.begin());
}

/// Leaves out nodes that no condition needs.
condition_list needed(condition_list list) {
  std::vector<char> used(list.nodes.size(), 0);
  for (const auto& c : list.conditions)
    for (const auto& term : c.terms)
      for (const int node : term.nodes) used[static_cast<std::size_t>(node)] = 1;
  const auto mark = [&used](const std::vector<int>& nodes) {
    for (const int n : nodes) used[static_cast<std::size_t>(n)] = 1;
  };
  for (std::size_t n = list.nodes.size(); n-- > 0;) {
    if (used[n] == 0) continue;
    mark(list.nodes[n].children);
    for (const auto& factors : list.nodes[n].merged) mark(factors);
  }
  condition_list kept;
  std::vector<int> place(list.nodes.size(), -1);
  const auto move = [&place](std::vector<int>& nodes) {
    for (int& n : nodes) n = place[static_cast<std::size_t>(n)];
  };
  for (std::size_t n = 0; n < list.nodes.size(); ++n) {
    if (used[n] == 0) continue;
    place[n] = static_cast<int>(kept.nodes.size());
    move(list.nodes[n].children);
    for (auto& factors : list.nodes[n].merged) move(factors);
    kept.nodes.push_back(list.nodes[n]);
  }
  kept.conditions = list.conditions;
  for (auto& c : kept.conditions)
    for (auto& term : c.terms) move(term.nodes);
  return kept;
}

design_condition tree_condition(const std::vector<rooted_tree>& trees, std::size_t k, std::size_t stages) {
  return {trees[k].name, {{1.0, {static_cast<int>(k)}, stages - 1}}, 1.0 / trees[k].density};
}

}  // namespace

condition_list order_equations(method_kind kind, int order, std::size_t stages,
                               const std::vector<char>& transport, const std::vector<char>& relaxation) {
  // The trees of order 2 serve the equations of stages.
  const auto trees = rooted_trees(std::max(order, 2), colours_of(kind));
  condition_list list{series_of(trees), {}};
  const bool equal_abscissae = kind == method_kind::imex && order >= 3;
  for (std::size_t k = 0; k < trees.size() && trees[k].order <= order; ++k)
    if (!equal_abscissae || !repeats_another(k, trees))
      list.conditions.push_back(tree_condition(trees, k, stages));
  for (std::size_t i = 0; i + 1 < stages && equal_abscissae; ++i)
    if (transport[i] != 0)
      list.conditions.push_back({fmt::format("c = c_hat at stage {}", i + 1),
                                 {{1.0, {index_of(trees, "G")}, i}, {-1.0, {index_of(trees, "F")}, i}},
                                 0.0});
  for (std::size_t i = 0; i < stages && kind == method_kind::implicit_only && order >= 5; ++i)
    if (relaxation[i] != 0) {
      const int c = index_of(trees, "G");
      list.conditions.push_back({fmt::format("order 2 of stage {}", i + 1),
                                 {{1.0, {index_of(trees, "G[G]")}, i}, {-0.5, {c, c}, i}},
                                 0.0});
    }
  return needed(std::move(list));
}

void add_regime_equations(condition_list& list, regime_demand demand, std::size_t stages) {
  if (demand == regime_demand::none) return;
  const auto add_node = [&list](series_node::kind what, std::vector<int> children) {
    list.nodes.push_back({what, std::move(children), {}});
    return static_cast<int>(list.nodes.size()) - 1;
  };
  const int kept = add_node(series_node::kind::kept, {});
  list.conditions.push_back({"last = 1", {{1.0, {kept}, stages - 1}}, 1.0});
  list.conditions.push_back(
      {"flux = 1", {{1.0, {add_node(series_node::kind::transport, {kept})}, stages - 1}}, 1.0});
  if (demand != regime_demand::all) return;
  const int layer = add_node(series_node::kind::layer, {});
  list.conditions.push_back(
      {"layer = 1", {{1.0, {add_node(series_node::kind::transport, {layer})}, stages - 1}}, 1.0});
}

condition_list error_terms(method_kind kind, int order, std::size_t stages) {
  const auto trees = rooted_trees(order, colours_of(kind));
  condition_list list{series_of(trees), {}};
  for (std::size_t k = 0; k < trees.size(); ++k)
    if (trees[k].order == order) list.conditions.push_back(tree_condition(trees, k, stages));
  return needed(std::move(list));
}

}  // namespace apsis
