#pragma once

#include <apsis/method/precision.hpp>
#include <apsis/method/tableau.hpp>

#include <string>
#include <vector>

namespace apsis::test {

/// The left-hand side of the order condition of a tree given by name, "G[F,G[F]]", and its exact value. The
/// recursions are independent of the code that names the condition in a message.
class named_tree {
 public:
  explicit named_tree(const std::string& name) {
    std::size_t at = 0;
    *this = named_tree(name, at);
  }

  int nodes() const {
    int sum = 1;
    for (const auto& child : children_) sum += child.nodes();
    return sum;
  }

  mp_real density() const {
    mp_real product = nodes();
    for (const auto& child : children_) product *= child.density();
    return product;
  }

  /// Returns the elementary weights at all stages; the last stage is u^{n+1}.
  std::vector<mp_real> weights(const butcher_form<mp_real>& b) const {
    const std::size_t s = b.A.rows();
    const auto at_stages = product(b, children_, children_.size());
    std::vector<mp_real> sums(s, mp_real(0));
    const auto add = [&](const matrix<mp_real>& coefficients, const std::vector<mp_real>& values) {
      for (std::size_t i = 0; i < s; ++i)
        for (std::size_t j = 0; j <= i; ++j) sums[i] += coefficients(i, j) * values[j];
    };
    add(root_ == 'F' ? b.A_hat : b.A, at_stages);
    // As Q̇ = Q'Q, the children of one factor G of the product replace this factor.
    for (std::size_t k = 0; root_ == 'G' && k < children_.size(); ++k) {
      if (children_[k].root_ != 'G') continue;
      auto values = product(b, children_, k);
      const auto& inner = children_[k].children_;
      const auto replaced = product(b, inner, inner.size());
      for (std::size_t j = 0; j < s; ++j) values[j] *= replaced[j];
      add(b.A_dot, values);
    }
    return sums;
  }

 private:
  named_tree(const std::string& name, std::size_t& at) : root_(name.at(at++)) {
    if (at == name.size() || name[at] != '[') return;
    do children_.push_back(named_tree(name, ++at));
    while (name.at(at) == ',');
    ++at;
  }

  static std::vector<mp_real> product(const butcher_form<mp_real>& b, const std::vector<named_tree>& trees,
                                      std::size_t without) {
    std::vector<mp_real> values(b.A.rows(), mp_real(1));
    for (std::size_t k = 0; k < trees.size(); ++k) {
      if (k == without) continue;
      const auto factor = trees[k].weights(b);
      for (std::size_t j = 0; j < values.size(); ++j) values[j] *= factor[j];
    }
    return values;
  }

  char root_ = 'F';
  std::vector<named_tree> children_;
};

}  // namespace apsis::test
