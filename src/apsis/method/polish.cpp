#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <apsis/core/errors.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/order_conditions.hpp>
#include <apsis/method/polish.hpp>
#include <apsis/method/precision.hpp>

namespace apsis {
namespace {

using vector = std::vector<mp_real>;

/// Solves K y = b by Gaussian elimination with row pivoting; false if K is singular to working precision.
bool solve(matrix<mp_real> K, vector b, vector& y) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (abs(K(i, k)) > abs(K(pivot, k))) pivot = i;
    if (abs(K(pivot, k)) < mp_real(1e-25)) return false;
    for (std::size_t j = k; j < n; ++j) std::swap(K(k, j), K(pivot, j));
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const mp_real factor = K(i, k) / K(k, k);
      for (std::size_t j = k; j < n; ++j) K(i, j) -= factor * K(k, j);
      b[i] -= factor * b[k];
    }
  }
  y.assign(n, mp_real(0));
  for (std::size_t i = n; i-- > 0;) {
    mp_real rest = b[i];
    for (std::size_t j = i + 1; j < n; ++j) rest -= K(i, j) * y[j];
    y[i] = rest / K(i, i);
  }
  return true;
}

/// The coefficients that move, and the equations that they must satisfy.
class polisher {
 public:
  explicit polisher(const method& m) : polished_(m), form_(m.coefficients<mp_real>()) {
    const std::size_t s = m.stages();
    for (std::size_t i = 0; i < s; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        add(polished_.exact.P(i, j), form_.P(i, j));
        add(polished_.exact.W(i, j), form_.W(i, j));
      }
      for (std::size_t j = 0; j <= i; ++j) add(polished_.exact.D(i, j), form_.D(i, j));
      add(polished_.exact.ddot[i], form_.ddot[i]);
    }
    add(polished_.exact.r, form_.r);
    find_full_rows();
    find_conditions();
  }

  method run(int digits) {
    constexpr int most_steps = 12;
    const mp_real enough(1e-54);
    for (int k = 0; k < most_steps && !unknowns_.empty(); ++k) {
      const vector residual = residuals();
      mp_real largest(0);
      for (const auto& x : residual) largest = std::max<mp_real>(largest, abs(x));
      if (largest < enough) break;
      if (k + 1 == most_steps)
        throw numerical_error(
            fmt::format("polishing '{}' does not converge (residual {} after {} steps) start from "
                        "coefficients that are nearer to a solution",
                        polished_.name, largest.str(3), most_steps));
      step(residual);
    }
    write(digits);
    return polished_;
  }

 private:
  struct unknown {
    std::string* text;
    mp_real* value;
  };

  void add(std::string& text, mp_real& value) {
    if (decimals(text) > 0) unknowns_.push_back({&text, &value});
  }

  bool moves(const mp_real& value) const {
    return std::any_of(unknowns_.begin(), unknowns_.end(),
                       [&](const unknown& u) { return u.value == &value; });
  }

  /// Rows with Σ_j p_ij + w_ij = 1 as far as the digits go: u^n does not enter, and must not after polishing.
  void find_full_rows() {
    const mp_real close = pow(mp_real(10), 1 - std::max(polished_.precision(), 2));
    const auto initial = initial_weights(form_);
    for (std::size_t i = 0; i < form_.stages(); ++i) {
      bool free = false;
      for (std::size_t j = 0; j < i; ++j) free = free || moves(form_.P(i, j)) || moves(form_.W(i, j));
      if (free && abs(initial[i]) <= close) full_rows_.push_back(i);
    }
  }

  void find_conditions() {
    const bool imex = polished_.kind == method_kind::imex;
    const auto colours = polished_.kind == method_kind::implicit_only ? tree_colours::G_only
                         : imex                                       ? tree_colours::both
                                                                      : tree_colours::F_only;
    trees_ = rooted_trees(polished_.claims.order, colours);
    // At order 2 the conditions are regular as they are, and c = ĉ need not hold.
    const bool reduced = imex && polished_.claims.order >= 3;
    for (std::size_t k = 0; k < trees_.size(); ++k)
      if (!reduced || !has_twin(trees_[k])) conditions_.push_back(k);
    if (!reduced) return;
    const auto b = to_butcher(form_);
    for (std::size_t j = 1; j < form_.stages(); ++j) {
      bool used = false;
      for (std::size_t i = j + 1; i < form_.stages(); ++i) used = used || b.A_hat(i, j) != 0;
      if (used) transport_stages_.push_back(j);
    }
  }

  /// A leaf G that hangs on an F may be replaced by a leaf F where c = ĉ: the same condition once more.
  bool has_twin(const rooted_tree& tree) const {
    return std::any_of(tree.children.begin(), tree.children.end(), [&](int index) {
      const rooted_tree& child = trees_[static_cast<std::size_t>(index)];
      const bool leaf_g = child.root == colour::G && child.children.empty();
      return (tree.root == colour::F && leaf_g) || has_twin(child);
    });
  }

  vector residuals() const {
    const auto b = to_butcher(form_);
    const auto weights = elementary_weights(b, trees_);
    vector f;
    for (const auto k : conditions_) f.push_back(weights[k] - mp_real(1) / mp_real(trees_[k].density));
    const auto initial = initial_weights(form_);
    for (const auto i : full_rows_) f.push_back(initial[i]);
    const vector ones(form_.stages(), mp_real(1));
    const vector c = b.A * ones, c_hat = b.A_hat * ones;
    for (const auto i : transport_stages_) f.push_back(c[i] - c_hat[i]);
    return f;
  }

  /// One Gauss-Newton step of least norm, x −= Jᵀ (J Jᵀ)⁻¹ f, with J from differences: at 60 digits they are
  /// good to 30, so each step gains that many.
  void step(const vector& f) {
    const mp_real h("1e-30");
    const std::size_t n = f.size();
    matrix<mp_real> J(n, unknowns_.size());
    for (std::size_t k = 0; k < unknowns_.size(); ++k) {
      const mp_real kept = *unknowns_[k].value;
      *unknowns_[k].value = kept + h;
      const vector moved = residuals();
      *unknowns_[k].value = kept;
      for (std::size_t i = 0; i < n; ++i) J(i, k) = (moved[i] - f[i]) / h;
    }
    matrix<mp_real> K(n, n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < unknowns_.size(); ++k) K(i, j) += J(i, k) * J(j, k);
    vector y;
    if (!solve(K, f, y))
      throw numerical_error(
          fmt::format("polishing '{}' fails (the order conditions are singular here) start from "
                      "other coefficients, or hold fewer of them as exact numbers",
                      polished_.name));
    for (std::size_t k = 0; k < unknowns_.size(); ++k)
      for (std::size_t i = 0; i < n; ++i) *unknowns_[k].value -= J(i, k) * y[i];
  }

  void write(int digits) {
    for (const auto& u : unknowns_) round_to(u, digits);
    // Rounding may have left a row a few units off 1; its largest weight takes them.
    for (const auto i : full_rows_) {
      const unknown* largest = nullptr;
      for (const auto& u : unknowns_)
        for (std::size_t j = 0; j < i; ++j)
          if ((u.value == &form_.P(i, j) || u.value == &form_.W(i, j)) &&
              (!largest || *u.value > *largest->value))
            largest = &u;
      *largest->value += initial_weights(form_)[i];
      round_to(*largest, digits);
    }
  }

  static void round_to(const unknown& u, int digits) {
    *u.text = u.value->str(digits, std::ios_base::fixed);
    *u.value = coefficient_value(*u.text);
  }

  method polished_;
  shu_osher_form<mp_real> form_;
  std::vector<unknown> unknowns_;
  std::vector<std::size_t> full_rows_, transport_stages_, conditions_;
  std::vector<rooted_tree> trees_;
};

}  // namespace

method polish(const method& m, int digits) {
  if (digits < 15 || digits > 50)
    throw input_error(
        fmt::format("cannot polish to {} digits (the arithmetic carries 60) ask for 15 to 50", digits));
  return polisher(m).run(digits);
}

}  // namespace apsis
