#include <apsis/method/order_conditions.hpp>

#include <apsis/method/lower_product.hpp>
#include <apsis/method/precision.hpp>

#include <cstddef>
#include <map>
#include <utility>

namespace apsis {
namespace {

template <class Real>
using stage_vector = std::vector<Real>;

/// Stage values φ of trees, evaluated in the order of a list.
template <class Real>
class evaluator {
 public:
  explicit evaluator(const butcher_form<Real>& method) : method_(method) {
    for (std::size_t i = 0; i < method.stages(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        has_derivatives_ = has_derivatives_ || method.A_dot(i, j) != Real(0);
  }

  /// Stores the values of all rows for the first `count` trees, to be used for trees that contain them.
  void complete(const std::vector<rooted_tree>& trees, std::size_t count) {
    while (phi_.size() < count) phi_.push_back(values(trees, trees[phi_.size()], 0));
  }

  /// Returns φ of a tree in the rows from `first`, 0 in the others. Requires the values of its subtrees.
  stage_vector<Real> values(const std::vector<rooted_tree>& trees, const rooted_tree& tree,
                            std::size_t first) const {
    auto product = ones();
    for (const int child : tree.children) multiply(product, child);
    if (tree.root == colour::F) return lower_product(method_.A_hat, product, first);
    if (!has_derivatives_) return lower_product(method_.A, product, first);

    stage_vector<Real> derivative(method_.stages(), Real(0));
    for (std::size_t k = 0; k < tree.children.size(); ++k) {
      const rooted_tree& child = trees[static_cast<std::size_t>(tree.children[k])];
      if (child.root != colour::G) continue;
      auto term = ones();
      for (std::size_t l = 0; l < tree.children.size(); ++l)
        if (l != k) multiply(term, tree.children[l]);
      for (const int grandchild : child.children) multiply(term, grandchild);
      for (std::size_t i = 0; i < term.size(); ++i) derivative[i] += term[i];
    }
    auto values = lower_product(method_.A, product, first);
    const auto second = lower_product(method_.A_dot, derivative, first);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += second[i];
    return values;
  }

  /// Returns φ(τ) in the last row of a tree that is stored.
  const Real& last(std::size_t tree) const { return phi_[tree].back(); }

 private:
  stage_vector<Real> ones() const { return stage_vector<Real>(method_.stages(), Real(1)); }

  void multiply(stage_vector<Real>& product, int tree) const {
    const auto& factor = phi_[static_cast<std::size_t>(tree)];
    for (std::size_t i = 0; i < product.size(); ++i) product[i] *= factor[i];
  }

  const butcher_form<Real>& method_;
  std::vector<stage_vector<Real>> phi_;
  bool has_derivatives_ = false;  ///< whether Q̇ occurs
};

/// Returns the number of trees below an order; trees are sorted by order.
std::size_t trees_below(int order, const std::vector<rooted_tree>& trees) {
  std::size_t count = 0;
  while (count < trees.size() && trees[count].order < order) ++count;
  return count;
}

}  // namespace

template <class Real>
std::vector<Real> elementary_weights(const butcher_form<Real>& method,
                                     const std::vector<rooted_tree>& trees) {
  if (trees.empty()) return {};
  // A tree of the highest order is no subtree: the value of u^{n+1} is enough.
  const std::size_t lower = trees_below(trees.back().order, trees);
  evaluator<Real> phi(method);
  phi.complete(trees, lower);
  std::vector<Real> weights;
  for (std::size_t k = 0; k < lower; ++k) weights.push_back(phi.last(k));
  for (std::size_t k = lower; k < trees.size(); ++k)
    weights.push_back(phi.values(trees, trees[k], method.stages() - 1).back());
  return weights;
}

template <class Real>
struct order_levels<Real>::parts {
  parts(butcher_form<Real> form, tree_colours of, std::size_t results)
      : method(std::move(form)), colours(of), first(method.stages() - results), phi(method) {}

  order_level<Real> level(int order) {
    if (trees.empty() || trees.back().order < order) trees = rooted_trees(order, colours);
    const std::size_t begin = trees_below(order, trees), end = trees_below(order + 1, trees);
    phi.complete(trees, begin);
    order_level<Real> made;
    made.weights.resize(method.stages() - first);
    for (std::size_t k = begin; k < end; ++k) {
      made.trees.push_back(trees[k]);
      const auto values = phi.values(trees, trees[k], first);
      for (std::size_t i = first; i < values.size(); ++i) made.weights[i - first].push_back(values[i]);
    }
    return made;
  }

  butcher_form<Real> method;
  tree_colours colours;
  std::size_t first;  ///< row of the first result
  evaluator<Real> phi;
  std::vector<rooted_tree> trees;
  std::map<int, order_level<Real>> levels;
};

template <class Real>
order_levels<Real>::order_levels(butcher_form<Real> method, tree_colours colours, std::size_t results)
    : parts_(std::make_unique<parts>(std::move(method), colours, results)) {}

template <class Real>
order_levels<Real>::~order_levels() = default;

template <class Real>
const order_level<Real>& order_levels<Real>::at(int order) {
  const auto found = parts_->levels.find(order);
  if (found != parts_->levels.end()) return found->second;
  return parts_->levels.emplace(order, parts_->level(order)).first->second;
}

template class order_levels<mp_real>;

template std::vector<double> elementary_weights(const butcher_form<double>&, const std::vector<rooted_tree>&);
template std::vector<long double> elementary_weights(const butcher_form<long double>&,
                                                     const std::vector<rooted_tree>&);
template std::vector<mp_real> elementary_weights(const butcher_form<mp_real>&,
                                                 const std::vector<rooted_tree>&);

}  // namespace apsis
