#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <boost/math/differentiation/autodiff.hpp>

namespace apsis {

/// First derivatives: x₀ + x₁ s with s² = 0.
template <class Real>
using dual = boost::math::differentiation::autodiff_fvar<Real, 1>;

/// Mixed second derivatives: x₀₀ + x₁₀ s + x₀₁ t + x₁₁ s t with s² = t² = 0.
template <class Real>
using nested_dual = boost::math::differentiation::autodiff_fvar<Real, 1, 1>;

/// Whether g(t, u, out) can be called, that is, whether G depends on time.
template <class G, class Real>
concept function_of_time =
    requires(G& g, const Real& t, std::span<const Real> in, std::span<Real> out) { g(t, in, out); };

/// Exact derivatives of u' = G(u) along given directions. g(u, out) sets out ← G(u) for any scalar type; both
/// arguments are std::span of Real, dual<Real> or nested_dual<Real>. Elementary functions must be called so
/// that they are found for these types: `using std::sin; out[0] = sin(u[0]);`.
///
/// If G depends on time, g is g(t, u, out), where t has the scalar type of u, and set_time() gives t. Time is
/// then a further unknown with derivative θ, so that Ġ = G'G + θ ∂G/∂t. θ is 1 where time advances along the
/// flow of G, and 0 where it is constant.
template <class Real, class G>
class vector_field {
 public:
  /// Whether G depends on time.
  static constexpr bool timed = function_of_time<G, Real>;

  /// Stores g(u, out) or g(t, u, out) as above.
  explicit vector_field(G g) : g_(std::move(g)) {}

  /// Sets t and θ of all evaluations that follow; initially 0. No effect unless `timed`.
  void set_time(Real t, Real theta) {
    t_ = t;
    theta_ = theta;
  }

  /// out ← G(u).
  void value(std::span<const Real> u, std::span<Real> out) {
    if constexpr (timed)
      g_(t_, u, out);
    else
      g_(u, out);
  }

  /// g ← G(u), g_dot ← Ġ(u) = G'(u) G(u) + θ ∂G/∂t, the second time derivative of a solution.
  void time_derivatives(std::span<const Real> u, std::span<Real> g, std::span<Real> g_dot) {
    value(u, g);
    flow_product(u, g, g_dot);
  }

  /// jx ← G'(u) x.
  void jacobian_product(std::span<const Real> u, std::span<const Real> x, std::span<Real> jx) {
    first_order(u, x, Real(0));
    for (std::size_t i = 0; i < u.size(); ++i) jx[i] = out1_[i].derivative(1);
  }

  /// jk ← G'(u) k + θ ∂G/∂t, the derivative of G along a flow with the rate k.
  void flow_product(std::span<const Real> u, std::span<const Real> k, std::span<Real> jk) {
    first_order(u, k, theta_);
    for (std::size_t i = 0; i < u.size(); ++i) jk[i] = out1_[i].derivative(1);
  }

  /// jx ← G'(u) x and kx ← Ġ'(u) x = (G'(u)² + G''(u)[·, G] + θ ∂G'/∂t) x: the coefficient of s t in
  /// G(u + s x + t G(u + s x)). One evaluation in dual and one in nested dual numbers.
  void second_product(std::span<const Real> u, std::span<const Real> x, std::span<Real> jx,
                      std::span<Real> kx) {
    jacobian_product(u, x, jx);
    second_order(u.size(), [&](std::size_t i, const auto& s, const auto& t, const auto& st) {
      return s * x[i] + t * Real(out1_[i].derivative(0)) + st * jx[i] + u[i];
    });
    for (std::size_t i = 0; i < u.size(); ++i) kx[i] = out2_[i].derivative(1, 1);
  }

  /// jx ← G'(u) x and hx ← G''(u)[k, x] + θ ∂G'/∂t x: the coefficients of s and s t in G(u + s x + t k).
  void curvature(std::span<const Real> u, std::span<const Real> k, std::span<const Real> x,
                 std::span<Real> jx, std::span<Real> hx) {
    second_order(u.size(), [&](std::size_t i, const auto& s, const auto& t, const auto&) {
      return s * x[i] + t * k[i] + u[i];
    });
    for (std::size_t i = 0; i < u.size(); ++i) {
      jx[i] = out2_[i].derivative(1, 0);
      hx[i] = out2_[i].derivative(1, 1);
    }
  }

 private:
  /// out2_ ← G(component(0, …), component(1, …), …) of the variables s, t and their product.
  template <class Component>
  void second_order(std::size_t n, const Component& component) {
    const nested_dual<Real> t(Real(0), true);              // the inner variable
    const nested_dual<Real> s(dual<Real>(Real(0), true));  // a dual number becomes the outer variable
    const nested_dual<Real> st = s * t;
    in2_.resize(n);
    out2_.resize(n);
    for (std::size_t i = 0; i < n; ++i) in2_[i] = component(i, s, t, st);
    const std::span<const nested_dual<Real>> in(in2_);
    // NOLINTNEXTLINE(misc-const-correctness): functions may take a reference to a span that is not constant.
    std::span<nested_dual<Real>> out(out2_);
    if constexpr (timed)
      g_(nested_dual<Real>(t * theta_ + t_), in, out);
    else
      g_(in, out);
  }

  /// out1_ ← G(u + s x) at the time t + θ s.
  void first_order(std::span<const Real> u, std::span<const Real> x, Real theta) {
    in1_.resize(u.size());
    out1_.resize(u.size());
    const dual<Real> s(Real(0), true);
    for (std::size_t i = 0; i < u.size(); ++i) in1_[i] = s * x[i] + u[i];
    const std::span<const dual<Real>> in(in1_);
    std::span<dual<Real>> out(out1_);  // NOLINT(misc-const-correctness): as above
    if constexpr (timed)
      g_(dual<Real>(s * theta + t_), in, out);
    else
      g_(in, out);
  }

  G g_;
  Real t_ = Real(0), theta_ = Real(0);
  std::vector<dual<Real>> in1_, out1_;
  std::vector<nested_dual<Real>> in2_, out2_;
};

/// Derivatives written by hand, for G whose code does not accept dual numbers:
///   value(u, out)              out ← G(u)
///   jacobian_product(u, x, jx)   jx ← G'(u) x; it enters Ġ = G'G, so that its error affects the solution
///   curvature(u, k, x, hx)       hx ← G''(u)[k, x]; its error only slows Newton's method
/// A G that depends on time has two more functions:
///   set_time(t)                  sets the time of all evaluations that follow
///   time_derivative(u, out)      out ← ∂G/∂t; it enters Ġ as well
template <class G, class Real>
concept differentiated = requires(G& g, std::span<const Real> in, std::span<Real> out) {
  g.value(in, out);
  g.jacobian_product(in, in, out);
  g.curvature(in, in, in, out);
};

/// Derivatives written by hand for a G that depends on time.
template <class G, class Real>
concept differentiated_in_time =
    differentiated<G, Real> && requires(G& g, Real t, std::span<const Real> in, std::span<Real> out) {
      g.set_time(t);
      g.time_derivative(in, out);
    };

/// The functions of vector_field for derivatives written by hand.
template <class Real, differentiated<Real> G>
class given_derivatives {
 public:
  /// Whether G depends on time.
  static constexpr bool timed = differentiated_in_time<G, Real>;

  /// Stores g with the functions of `differentiated`.
  explicit given_derivatives(G g) : g_(std::move(g)) {}

  /// Sets t and θ of all evaluations that follow; see vector_field.
  void set_time(Real t, Real theta) {
    if constexpr (timed) g_.set_time(t);
    theta_ = theta;
  }

  /// out ← G(u).
  void value(std::span<const Real> u, std::span<Real> out) { g_.value(u, out); }
  /// g ← G(u), g_dot ← G'(u) G(u) + θ ∂G/∂t.
  void time_derivatives(std::span<const Real> u, std::span<Real> g, std::span<Real> g_dot) {
    g_.value(u, g);
    flow_product(u, g, g_dot);
  }
  /// jk ← G'(u) k + θ ∂G/∂t.
  void flow_product(std::span<const Real> u, std::span<const Real> k, std::span<Real> jk) {
    g_.jacobian_product(u, k, jk);
    if constexpr (timed) {
      if (theta_ == Real(0)) return;
      bent_.resize(u.size());
      g_.time_derivative(u, bent_);
      for (std::size_t i = 0; i < u.size(); ++i) jk[i] += theta_ * bent_[i];
    }
  }
  /// jx ← G'(u) x.
  void jacobian_product(std::span<const Real> u, std::span<const Real> x, std::span<Real> jx) {
    g_.jacobian_product(u, x, jx);
  }
  /// jx ← G'(u) x and kx ← (G'(u)² + G''(u)[·, G]) x.
  void second_product(std::span<const Real> u, std::span<const Real> x, std::span<Real> jx,
                      std::span<Real> kx) {
    rate_.resize(u.size());
    bent_.resize(u.size());
    g_.value(u, rate_);
    g_.curvature(u, rate_, x, bent_);
    g_.jacobian_product(u, x, jx);
    g_.jacobian_product(u, jx, kx);
    for (std::size_t i = 0; i < u.size(); ++i) kx[i] += bent_[i];
  }
  /// jx ← G'(u) x and hx ← G''(u)[k, x].
  void curvature(std::span<const Real> u, std::span<const Real> k, std::span<const Real> x,
                 std::span<Real> jx, std::span<Real> hx) {
    g_.jacobian_product(u, x, jx);
    g_.curvature(u, k, x, hx);
  }

 private:
  G g_;
  Real theta_ = Real(0);
  std::vector<Real> rate_, bent_;
};

/// @cond
namespace detail {
template <class Real, class G>
struct field_of {
  using type = vector_field<Real, G>;
};
template <class Real, differentiated<Real> G>
struct field_of<Real, G> {
  using type = given_derivatives<Real, G>;
};
}  // namespace detail

/// given_derivatives for a G with derivatives written by hand, else vector_field.
template <class Real, class G>
using field_of = typename detail::field_of<Real, G>::type;
/// @endcond

}  // namespace apsis
