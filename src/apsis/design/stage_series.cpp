#include <apsis/design/stage_series.hpp>

namespace apsis {

std::vector<series_node> series_of(const std::vector<rooted_tree>& trees) {
  std::vector<series_node> nodes;
  for (const rooted_tree& tree : trees) {
    series_node node;
    node.what = tree.root == colour::F ? series_node::kind::transport : series_node::kind::relaxation;
    node.children = tree.children;
    node.previous = tree.order % 2 == 0 ? 1.0 : -1.0;
    node.divisor = tree.density;
    for (std::size_t k = 0; tree.root == colour::G && k < tree.children.size(); ++k) {
      const rooted_tree& child = trees[static_cast<std::size_t>(tree.children[k])];
      if (child.root != colour::G) continue;
      std::vector<int> factors = child.children;
      for (std::size_t l = 0; l < tree.children.size(); ++l)
        if (l != k) factors.push_back(tree.children[l]);
      node.merged.push_back(factors);
    }
    nodes.push_back(node);
  }
  return nodes;
}

}  // namespace apsis
