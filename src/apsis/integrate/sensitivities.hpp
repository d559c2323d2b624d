#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/autodiff.hpp>
#include <apsis/integrate/sparsity_pattern.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// A function G(t, u; p) with the derivatives s_k = ∂u/∂p_k of its solutions as further unknowns:
///   u' = G(t, u; p),   s_k' = G_u s_k + G_{p_k},   k = 1 … m.
/// The unknowns are (u, s_1, …, s_m), n(1 + m) numbers. All derivatives are exact (automatic), except those
/// of third order, which only Newton's method uses. An object is the G of a newton_problem (`differentiated`)
/// or, as a function of (t, u, out), its F; both parts then have the same parameters. A method gives the
/// exact derivatives of its own solutions if steps do not depend on p. See Maly & Petzold, Appl. Numer. Math.
/// 20 (1996) 57.
///
/// g(u, p, out) or g(t, u, p, out) sets out ← G for any scalar type; u, p and out are std::span of it.
template <class G, class Real = double>
class sensitivities {
 public:
  /// Stores g and the values of the parameters. Throws input_error without parameters and for a value that is
  /// not finite.
  sensitivities(G g, std::vector<Real> parameters)
      : parameters_(std::move(parameters)), field_(whole{std::move(g), parameters_.size()}) {
    if (parameters_.empty())
      throw input_error("there are no parameters (derivatives are those by a parameter); give at least one");
    for (std::size_t k = 0; k < parameters_.size(); ++k)
      if (!std::isfinite(parameters_[k]))
        throw input_error("parameter " + std::to_string(k) +
                          " is not finite (G depends on it); give a number");
  }

  std::size_t parameters() const { return parameters_.size(); }  ///< m

  /// Returns (u, 0, …, 0): the start of a solution that begins with u for all values of the parameters.
  std::vector<Real> start(std::span<const Real> u) const {
    std::vector<Real> all(u.size() * (1 + parameters()), Real(0));
    std::copy(u.begin(), u.end(), all.begin());
    return all;
  }
  /// Returns the part s_k of the unknowns, k from 0.
  std::span<const Real> part(std::span<const Real> all, std::size_t k) const {
    const std::size_t n = size_of(all);
    return all.subspan(n * (1 + k), n);
  }
  /// Returns the pattern of the derivative for G_u of the given pattern.
  sparsity_pattern pattern(const sparsity_pattern& of) const {
    const std::size_t n = of.size();
    std::vector<sparsity_pattern::place> places;
    for (std::size_t j = 0; j < n; ++j)
      for (const std::size_t i : of.rows(j))
        for (std::size_t k = 0; k <= parameters(); ++k) {
          places.emplace_back(n * k + i, j);
          places.emplace_back(n * k + i, n * k + j);
        }
    return {n * (1 + parameters()), places};
  }

  /// Sets t of all evaluations that follow; initially 0.
  void set_time(Real t) { t_ = t; }
  /// out ← (G, G_u s_1 + G_{p_1}, …).
  void value(std::span<const Real> all, std::span<Real> out) {
    const std::size_t n = load(all);
    field_.value(at_, result_);
    put(out.first(n));
    for (std::size_t k = 0; k < parameters(); ++k) {
      set_direction(changes_, part(all, k), k);
      field_.jacobian_product(at_, changes_, result_);
      put(out.subspan(n * (1 + k), n));
    }
  }
  /// out ← the value at the time t: the form of a transport F.
  void operator()(Real t, const std::vector<Real>& all, std::vector<Real>& out) {
    t_ = t;
    value(all, out);
  }
  /// jx ← the derivative of value() in the direction x.
  void jacobian_product(std::span<const Real> all, std::span<const Real> x, std::span<Real> jx) {
    const std::size_t n = load(all);
    set_direction(along_, x.first(n));
    differentiate(all, jx);
    for (std::size_t k = 0; k < parameters(); ++k) {
      set_direction(along_, x.subspan(n * (1 + k), n));
      field_.jacobian_product(at_, along_, result_);
      add(jx.subspan(n * (1 + k), n));
    }
  }
  /// hx ← the second derivative of value() in the directions q and x, without the third derivatives of G.
  void curvature(std::span<const Real> all, std::span<const Real> q, std::span<const Real> x,
                 std::span<Real> hx) {
    const std::size_t n = load(all);
    second(q.first(n), x.first(n));
    put(hx.first(n));
    for (std::size_t k = 1; k <= parameters(); ++k) {
      second(q.subspan(n * k, n), x.first(n));
      put(hx.subspan(n * k, n));
      second(q.first(n), x.subspan(n * k, n));
      add(hx.subspan(n * k, n));
    }
  }
  /// out ← ∂/∂t of value().
  void time_derivative(std::span<const Real> all, std::span<Real> out) {
    load(all);
    set_direction(along_, {});
    along_.back() = Real(1);
    differentiate(all, out);
  }

 private:
  /// g as a function of (u, p, t).
  struct whole {
    G g;
    std::size_t parameters;
    template <class Scalar>
    void operator()(std::span<const Scalar> z, std::span<Scalar> out) const {
      const std::size_t n = z.size() - parameters - 1;
      const auto u = z.first(n), p = z.subspan(n, parameters);
      const std::span<Scalar> to = out.first(n);
      if constexpr (requires { g(z.back(), u, p, to); })
        g(z.back(), u, p, to);
      else
        g(u, p, to);
    }
  };

  std::size_t size_of(std::span<const Real> all) const { return all.size() / (1 + parameters()); }

  /// Sets at_ to (u, p, t); returns n.
  std::size_t load(std::span<const Real> all) {
    const std::size_t n = size_of(all);
    at_.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n));
    at_.insert(at_.end(), parameters_.begin(), parameters_.end());
    at_.push_back(t_);
    for (std::vector<Real>* one : {&along_, &changes_, &result_, &unused_}) one->resize(at_.size());
    return n;
  }
  /// Sets a change of (u, p, t) to (x, 0, 0).
  static void set_direction(std::vector<Real>& to, std::span<const Real> x) {
    std::fill(std::copy(x.begin(), x.end(), to.begin()), to.end(), Real(0));
  }
  /// Sets a change of (u, p, t) to (x, e_k, 0).
  static void set_direction(std::vector<Real>& to, std::span<const Real> x, std::size_t k) {
    set_direction(to, x);
    to[x.size() + k] = Real(1);
  }
  /// Copies or adds the first numbers of result_.
  void put(std::span<Real> out) const { std::copy_n(result_.begin(), out.size(), out.begin()); }
  void add(std::span<Real> out) const {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += result_[i];
  }

  /// out ← the derivative of value() along the change along_ of (u, p, t), with fixed s.
  void differentiate(std::span<const Real> all, std::span<Real> out) {
    const std::size_t n = size_of(all);
    field_.jacobian_product(at_, along_, result_);
    put(out.first(n));
    for (std::size_t k = 0; k < parameters(); ++k) {
      set_direction(changes_, part(all, k), k);
      field_.curvature(at_, changes_, along_, unused_, result_);
      put(out.subspan(n * (1 + k), n));
    }
  }
  /// result_ ← G_uu[q, x].
  void second(std::span<const Real> q, std::span<const Real> x) {
    set_direction(changes_, q);
    set_direction(along_, x);
    field_.curvature(at_, changes_, along_, unused_, result_);
  }

  std::vector<Real> parameters_;
  vector_field<Real, whole> field_;
  Real t_ = Real(0);
  std::vector<Real> at_, along_, changes_, result_, unused_;
};

}  // namespace apsis
