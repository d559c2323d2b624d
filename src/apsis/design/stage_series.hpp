#pragma once

#include <apsis/method/tableau.hpp>
#include <apsis/method/trees.hpp>

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// Definition of a stage vector y in terms of others, given by their indices in the list.
struct series_node {
  /// Defining equation of y.
  enum class kind {
    transport,   ///< R y = (W/r) Π children: a tree with root T
    relaxation,  ///< R y = D Π children + Ḋ Σ_k (Π_{l≠k} children)(Π children of child k): a tree with root Q
    kept,        ///< y_i = Σ_j w_ij/(r d_i) if ḋ_i = 0 and d_i > 0, else 0: χ of docs/plateaus.md
    layer,       ///< y_i = r_i/d_i for the same stages, else 0: λ of docs/plateaus.md
    response,  ///< y_i = (Σ_j m_ij y_j + r_i)/(1 − ζ d_i − ζ² ḋ_i), M = P + W: R(ζ) at stage i of u' = ζu/Δt
    moved,     ///< response with −ζ Σ_j w_ij/r in place of r_i: for ζ = −z, κ of docs/plateaus.md apart from
               ///< its initial term
    imaginary  ///< imaginary part of the previous node, which is `response` or `moved`
  };
  kind what = kind::transport;  ///< defining equation of y
  std::vector<int> children;    ///< the factors of Π children (nodes of kind transport and relaxation)
  std::vector<std::vector<int>> merged;  ///< the factors of each term of Ḋ (nodes of kind relaxation)
  std::complex<double> zeta = 0.0;       ///< ζ (nodes of kind response and moved)
  double previous = 0.0,                 ///< y of u^{n−1} times `divisor` (two-step methods)
      divisor = 1.0;                     ///< γ(τ) for a tree
};

/// Returns the nodes of the stage vectors of trees, in the same order (rooted_trees() puts children first).
std::vector<series_node> series_of(const std::vector<rooted_tree>& trees);

/// Computes the stage vectors of a method in Shu–Osher form with diagonal D. A reverse sweep gives the exact
/// gradient of any weighted sum of their entries with respect to P, W, d, ḋ and r. Over `tangent` instead of
/// double, the gradient carries second derivatives.
///
/// `slow[i]` marks stages with ḋ_i = 0 by design (not by value), so that χ and λ are smooth functions.
///
/// The first row of a two-step method stands for u^{n−1}; the nodes give its values.
template <class Real>
class stage_series {
 public:
  /// Arguments of a node must precede it; `slow` has one entry per stage, `steps` is 1 or 2.
  stage_series(std::span<const series_node> nodes, std::vector<char> slow, int steps = 1)
      : nodes_(nodes.begin(), nodes.end()), slow_(std::move(slow)), first_(steps == 2 ? 1 : 0) {}

  /// Computes all stage vectors of a method. Only the diagonal of D is used.
  void evaluate(const shu_osher_form<Real>& m) {
    s_ = m.stages();
    r_ = m.r;
    resize();
    ddot_ = m.ddot;
    for (std::size_t i = 0; i < s_; ++i) {
      d_[i] = m.D(i, i);
      initial_[i] = Real(1.0);
      for (std::size_t j = 0; j < i; ++j) {
        weight(i, j) = m.P(i, j) + m.W(i, j);
        advance(i, j) = m.W(i, j) / r_;
        initial_[i] -= weight(i, j);
      }
    }
    for (std::size_t n = 0; n < nodes_.size(); ++n) evaluate_node(n);
  }

  /// Returns entry `stage` (from 0) of a stage vector. Requires evaluate().
  const Real& value(int node, std::size_t stage) const {
    return y_[static_cast<std::size_t>(node) * s_ + stage];
  }

  /// Adds weight · y_stage of the node to the sum that reverse() differentiates.
  void seed(int node, std::size_t stage, const Real& weight) {
    adjoint_[static_cast<std::size_t>(node) * s_ + stage] += weight;
    active_[static_cast<std::size_t>(node)] = 1;
  }

  /// Adds the gradient of the seeded sum to `out` (P, W, diagonal of D, ddot, r) and clears the seeds.
  void reverse(shu_osher_form<Real>& out) {
    for (std::size_t n = nodes_.size(); n-- > 0;)
      if (active_[n] != 0) reverse_node(n, out);
    // W enters V = W/r and M = P + W.
    for (std::size_t i = 0; i < s_; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        Real& v = V_bar_[i * s_ + j];
        Real& w = M_bar_[i * s_ + j];
        out.P(i, j) += w;
        out.W(i, j) += w + v / r_;
        out.r -= v * advance(i, j) / r_;
        v = w = Real(0.0);
      }
  }

 private:
  struct complex_pair {
    Real re, im;
  };
  static bool is_response(const series_node& node) {
    return node.what == series_node::kind::response || node.what == series_node::kind::moved;
  }
  Real& weight(std::size_t i, std::size_t j) { return M_[i * s_ + j]; }
  Real& advance(std::size_t i, std::size_t j) { return V_[i * s_ + j]; }

  void resize() {
    const std::size_t all = nodes_.size() * s_;
    if (y_.size() == all && d_.size() == s_) return;
    for (auto* v : {&y_, &g_, &h_, &adjoint_}) v->assign(all, Real(0.0));
    for (auto* v : {&M_, &V_, &M_bar_, &V_bar_}) v->assign(s_ * s_, Real(0.0));
    for (auto* v : {&d_, &initial_, &g_bar_, &h_bar_}) v->assign(s_, Real(0.0));
    active_.assign(nodes_.size(), 0);
  }

  /// Returns Π_{f in factors, f ≠ left_out} y_f at a stage; left_out is a position in `factors`.
  Real product(const std::vector<int>& factors, std::size_t stage, std::size_t left_out) const {
    Real p(1.0);
    for (std::size_t f = 0; f < factors.size(); ++f)
      if (f != left_out) p *= value(factors[f], stage);
    return p;
  }
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// 1 − ζ d_i − ζ² ḋ_i.
  complex_pair denominator(std::complex<double> zeta, std::size_t i) const {
    const auto square = zeta * zeta;
    return {Real(1.0) - Real(zeta.real()) * d_[i] - Real(square.real()) * ddot_[i],
            -(Real(zeta.imag()) * d_[i] + Real(square.imag()) * ddot_[i])};
  }

  void evaluate_response(std::size_t n) {
    const auto zeta = nodes_[n].zeta;
    const bool moved = nodes_[n].what == series_node::kind::moved;
    Real* re = &y_[n * s_];
    Real* im = &y_[(n + 1) * s_];
    if (first_ == 1) re[0] = Real(nodes_[n].previous) / Real(nodes_[n].divisor);
    for (std::size_t i = first_; i < s_; ++i) {
      complex_pair sum{Real(0.0), Real(0.0)};
      if (!moved) sum.re = initial_[i];
      for (std::size_t j = 0; j < i; ++j) {
        sum.re += weight(i, j) * re[j];
        sum.im += weight(i, j) * im[j];
        if (!moved) continue;
        sum.re -= Real(zeta.real()) * advance(i, j);
        sum.im -= Real(zeta.imag()) * advance(i, j);
      }
      const auto q = denominator(zeta, i);
      const Real size = q.re * q.re + q.im * q.im;
      re[i] = (sum.re * q.re + sum.im * q.im) / size;
      im[i] = (sum.im * q.re - sum.re * q.im) / size;
    }
  }

  /// For y = S/q with adjoint A of y, the adjoint of S is S̄ = A q/|q|², and that of q is −S̄ conj(y).
  void reverse_response(std::size_t n, shu_osher_form<Real>& out) {
    const auto zeta = nodes_[n].zeta, square = zeta * zeta;
    const bool moved = nodes_[n].what == series_node::kind::moved;
    const Real* re = &y_[n * s_];
    const Real* im = &y_[(n + 1) * s_];
    Real* bar_re = &adjoint_[n * s_];
    Real* bar_im = &adjoint_[(n + 1) * s_];
    for (std::size_t i = s_; i-- > first_;) {
      const auto q = denominator(zeta, i);
      const Real size = q.re * q.re + q.im * q.im;
      const complex_pair S{(bar_re[i] * q.re - bar_im[i] * q.im) / size,
                           (bar_re[i] * q.im + bar_im[i] * q.re) / size};
      bar_re[i] = bar_im[i] = Real(0.0);
      const complex_pair q_bar{-(S.re * re[i] + S.im * im[i]), S.re * im[i] - S.im * re[i]};
      out.D(i, i) -= Real(zeta.real()) * q_bar.re + Real(zeta.imag()) * q_bar.im;
      out.ddot[i] -= Real(square.real()) * q_bar.re + Real(square.imag()) * q_bar.im;
      const Real source = Real(zeta.real()) * S.re + Real(zeta.imag()) * S.im;
      for (std::size_t j = 0; j < i; ++j) {
        bar_re[j] += weight(i, j) * S.re;
        bar_im[j] += weight(i, j) * S.im;
        M_bar_[i * s_ + j] += re[j] * S.re + im[j] * S.im;
        if (moved) {
          V_bar_[i * s_ + j] -= source;
        } else {
          M_bar_[i * s_ + j] -= S.re;
        }
      }
    }
    if (first_ == 1) bar_re[0] = bar_im[0] = Real(0.0);
  }

  void evaluate_node(std::size_t n) {
    const series_node& node = nodes_[n];
    if (is_response(node)) evaluate_response(n);
    if (is_response(node) || node.what == series_node::kind::imaginary) return;
    Real* y = &y_[n * s_];
    Real* g = &g_[n * s_];
    Real* h = &h_[n * s_];
    if (first_ == 1) y[0] = Real(node.previous) / Real(node.divisor);
    if (node.what == series_node::kind::kept || node.what == series_node::kind::layer) {
      for (std::size_t i = first_; i < s_; ++i) {
        y[i] = Real(0.0);
        if (slow_[i] == 0) continue;
        Real source = node.what == series_node::kind::layer ? initial_[i] : Real(0.0);
        if (node.what == series_node::kind::kept)
          for (std::size_t j = 0; j < i; ++j) source += advance(i, j);
        y[i] = source / d_[i];
      }
      return;
    }
    const bool relaxes = node.what == series_node::kind::relaxation;
    for (std::size_t i = 0; i < s_; ++i) {
      g[i] = product(node.children, i, none);
      Real sum(0.0);
      if (i < first_) continue;
      if (relaxes) {
        h[i] = Real(0.0);
        for (const auto& factors : node.merged) h[i] += product(factors, i, none);
        sum = d_[i] * g[i] + ddot_[i] * h[i];
        for (std::size_t j = 0; j < i; ++j) sum += weight(i, j) * y[j];
      } else {
        for (std::size_t j = 0; j < i; ++j) sum += weight(i, j) * y[j] + advance(i, j) * g[j];
      }
      y[i] = sum;
    }
  }

  void reverse_source(std::size_t n, shu_osher_form<Real>& out) {
    const bool layer = nodes_[n].what == series_node::kind::layer;
    for (std::size_t i = 0; i < s_; ++i) {
      const Real a = adjoint_[n * s_ + i];
      adjoint_[n * s_ + i] = Real(0.0);
      if (slow_[i] == 0 || i < first_) continue;
      const Real per_d = a / d_[i];
      out.D(i, i) -= per_d * y_[n * s_ + i];
      for (std::size_t j = 0; j < i; ++j) {
        if (layer) {
          M_bar_[i * s_ + j] -= per_d;
        } else {
          V_bar_[i * s_ + j] += per_d;
        }
      }
    }
  }

  void reverse_node(std::size_t n, shu_osher_form<Real>& out) {
    active_[n] = 0;
    const series_node& node = nodes_[n];
    if (node.what == series_node::kind::imaginary) {
      active_[n - 1] = 1;
      return;
    }
    if (is_response(node)) {
      reverse_response(n, out);
      return;
    }
    if (node.what == series_node::kind::kept || node.what == series_node::kind::layer) {
      reverse_source(n, out);
      return;
    }
    const bool relaxes = node.what == series_node::kind::relaxation;
    const Real* y = &y_[n * s_];
    const Real* g = &g_[n * s_];
    Real* bar = &adjoint_[n * s_];
    for (std::size_t i = 0; i < s_; ++i) g_bar_[i] = h_bar_[i] = Real(0.0);
    for (std::size_t i = s_; i-- > 0;) {
      const Real a = bar[i];
      bar[i] = Real(0.0);
      if (i < first_) continue;
      for (std::size_t j = 0; j < i; ++j) {
        bar[j] += a * weight(i, j);
        M_bar_[i * s_ + j] += a * y[j];
        if (relaxes) continue;
        V_bar_[i * s_ + j] += a * g[j];
        g_bar_[j] += a * advance(i, j);
      }
      if (!relaxes) continue;
      out.D(i, i) += a * g[i];
      out.ddot[i] += a * h_[n * s_ + i];
      g_bar_[i] += a * d_[i];
      h_bar_[i] += a * ddot_[i];
    }
    spread(node.children, g_bar_);
    for (const auto& factors : node.merged) spread(factors, h_bar_);
  }

  /// Adds the adjoint of a product to its factors.
  void spread(const std::vector<int>& factors, const std::vector<Real>& bar) {
    for (std::size_t f = 0; f < factors.size(); ++f) {
      const auto child = static_cast<std::size_t>(factors[f]);
      active_[child] = 1;
      for (std::size_t i = 0; i < s_; ++i) adjoint_[child * s_ + i] += bar[i] * product(factors, i, f);
    }
  }

  std::vector<series_node> nodes_;
  std::vector<char> slow_, active_;
  std::size_t first_;  ///< first row that is computed
  std::size_t s_ = 0;
  Real r_{};
  std::vector<Real> y_, g_, h_, adjoint_;    ///< nodes × stages
  std::vector<Real> M_, V_, M_bar_, V_bar_;  ///< P + W and W/r, s × s, and their adjoints
  std::vector<Real> d_, ddot_, initial_, g_bar_, h_bar_;
};

}  // namespace apsis
