#include <apsis/method/order_conditions.hpp>

#include <apsis/method/lower_product.hpp>
#include <apsis/method/precision.hpp>

#include <algorithm>

namespace apsis {
namespace {

template <class Real>
using stage_vector = std::vector<Real>;

template <class Real>
class evaluator {
 public:
  evaluator(const butcher_form<Real>& method, const std::vector<rooted_tree>& trees)
      : method_(method), trees_(trees) {
    for (std::size_t i = 0; i < method.stages(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        has_derivatives_ = has_derivatives_ || method.A_dot(i, j) != Real(0);
  }

  std::vector<Real> run() {
    std::vector<Real> weights;
    int highest = 0;
    for (const rooted_tree& tree : trees_) highest = std::max(highest, tree.order);
    for (const rooted_tree& tree : trees_) {
      // A tree of the highest order is no subtree: the value of u^{n+1} is enough.
      first_row_ = tree.order == highest ? method_.stages() - 1 : 0;
      phi_.push_back(stage_values(tree));
      weights.push_back(phi_.back().back());
      if (tree.order == highest) phi_.back().clear();
    }
    return weights;
  }

 private:
  stage_vector<Real> ones() const { return stage_vector<Real>(method_.stages(), Real(1)); }

  void multiply(stage_vector<Real>& product, int tree) const {
    const auto& factor = phi_[static_cast<std::size_t>(tree)];
    for (std::size_t i = 0; i < product.size(); ++i) product[i] *= factor[i];
  }

  stage_vector<Real> stage_values(const rooted_tree& tree) const {
    auto product = ones();
    for (const int child : tree.children) multiply(product, child);
    if (tree.root == colour::F) return lower_product(method_.A_hat, product, first_row_);
    if (!has_derivatives_) return lower_product(method_.A, product, first_row_);

    stage_vector<Real> derivative(method_.stages(), Real(0));
    for (std::size_t k = 0; k < tree.children.size(); ++k) {
      const rooted_tree& child = trees_[static_cast<std::size_t>(tree.children[k])];
      if (child.root != colour::G) continue;
      auto term = ones();
      for (std::size_t l = 0; l < tree.children.size(); ++l)
        if (l != k) multiply(term, tree.children[l]);
      for (const int grandchild : child.children) multiply(term, grandchild);
      for (std::size_t i = 0; i < term.size(); ++i) derivative[i] += term[i];
    }
    auto values = lower_product(method_.A, product, first_row_);
    const auto second = lower_product(method_.A_dot, derivative, first_row_);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += second[i];
    return values;
  }

  const butcher_form<Real>& method_;
  const std::vector<rooted_tree>& trees_;
  std::vector<stage_vector<Real>> phi_;
  std::size_t first_row_ = 0;
  bool has_derivatives_ = false;  ///< whether Q̇ occurs
};

}  // namespace

template <class Real>
std::vector<Real> elementary_weights(const butcher_form<Real>& method,
                                     const std::vector<rooted_tree>& trees) {
  return evaluator<Real>(method, trees).run();
}

template std::vector<double> elementary_weights(const butcher_form<double>&, const std::vector<rooted_tree>&);
template std::vector<long double> elementary_weights(const butcher_form<long double>&,
                                                     const std::vector<rooted_tree>&);
template std::vector<mp_real> elementary_weights(const butcher_form<mp_real>&,
                                                 const std::vector<rooted_tree>&);

}  // namespace apsis
