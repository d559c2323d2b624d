#include <apsis/method/trees.hpp>

namespace apsis {
namespace {

rooted_tree make_tree(colour root, const std::vector<int>& children, const std::vector<rooted_tree>& known) {
  rooted_tree tree;
  tree.root = root;
  tree.children = children;
  tree.name = root == colour::F ? "F" : "G";
  for (std::size_t k = 0; k < children.size(); ++k) {
    const rooted_tree& child = known[static_cast<std::size_t>(children[k])];
    tree.order += child.order;
    tree.density *= child.density;
    tree.name += (k == 0 ? "[" : ",") + child.name;
  }
  if (!children.empty()) tree.name += "]";
  tree.density *= tree.order;
  return tree;
}

/// Appends every sorted list of trees (indices ≥ first) with `nodes` nodes in total.
void forests(int nodes, int first, const std::vector<rooted_tree>& known, std::vector<int>& list,
             std::vector<std::vector<int>>& found) {
  if (nodes == 0) {
    found.push_back(list);
    return;
  }
  for (int k = first; k < static_cast<int>(known.size()) && known[static_cast<std::size_t>(k)].order <= nodes;
       ++k) {
    list.push_back(k);
    forests(nodes - known[static_cast<std::size_t>(k)].order, k, known, list, found);
    list.pop_back();
  }
}

}  // namespace

std::vector<rooted_tree> rooted_trees(int order, tree_colours colours) {
  std::vector<rooted_tree> trees;
  for (int nodes = 1; nodes <= order; ++nodes) {
    std::vector<std::vector<int>> found;
    std::vector<int> list;
    forests(nodes - 1, 0, trees, list, found);
    std::vector<rooted_tree> grown;
    for (const colour root : {colour::F, colour::G}) {
      if (root == colour::F && colours == tree_colours::G_only) continue;
      if (root == colour::G && colours == tree_colours::F_only) continue;
      for (const auto& children : found) grown.push_back(make_tree(root, children, trees));
    }
    trees.insert(trees.end(), grown.begin(), grown.end());
  }
  return trees;
}

}  // namespace apsis
