#pragma once

#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/jet.hpp>
#include <apsis/integrate/lanes.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace apsis {

/// Counts of an ensemble, over all groups of eight systems.
struct ensemble_counts {
  long steps = 0,      ///< accepted steps
      rejected = 0,    ///< rejected steps
      solves = 0,      ///< stage solves
      iterations = 0,  ///< of Newton's method; one for each solve of a linearly implicit step
      matrices = 0;    ///< Jacobian matrices
};

/// @cond
namespace ensemble_parts {

/// The largest of ratios ≥ 0, in every lane and in all of them.
class largest_ratio {
 public:
  void add(const lanes& ratio) {
    largest_ = larger(largest_, ratio);
    doubt_ += ratio - ratio;  // 0, or NaN
  }
  /// The largest of all lanes, NaN if one is not finite.
  double of_all() const { return of_lanes()[worst()]; }
  /// The lane of the largest ratio, or one that is not finite.
  std::size_t worst() const {
    const lanes all = of_lanes();
    std::size_t lane = 0;
    for (std::size_t k = 1; k < lanes::count; ++k)
      if (!(all[k] <= all[lane])) lane = k;
    return lane;
  }

 private:
  lanes of_lanes() const { return largest_ + doubt_; }
  lanes largest_ = 0.0, doubt_ = 0.0;
};

/// u' = F(t, u, p) + G(t, u, p) for eight systems, with the tolerances of the unknowns.
template <std::size_t N, std::size_t Parameters, class F, class G>
class lane_system {
 public:
  using unknowns = std::array<lanes, N>;
  using matrix = std::array<unknowns, N>;

  lane_system(const F& f, const G& g, const component_tolerances<double>& tolerances) : f_(&f), g_(&g) {
    for (std::size_t i = 0; i < N; ++i) {
      relative_[i] = tolerances.relative(i);
      absolute_[i] = tolerances.absolute(i);
    }
  }

  std::array<lanes, Parameters> parameters;
  ensemble_counts counts;

  unknowns transport(double t, const unknowns& u) const { return rate(*f_, t, u); }
  unknowns collision(double t, const unknowns& u) const { return rate(*g_, t, u); }

  /// Returns G(t, u), and sets its Jacobian matrix.
  unknowns collision(double t, const unknowns& u, matrix& jacobian) {
    ++counts.matrices;
    std::array<jet<N>, N> in, out;
    for (std::size_t i = 0; i < N; ++i) {
      in[i] = jet<N>(u[i]);
      in[i].by[i] = 1.0;
    }
    (*g_)(t, std::span<const jet<N>, N>(in), given(), std::span<jet<N>, N>(out));
    unknowns value;
    for (std::size_t i = 0; i < N; ++i) {
      value[i] = out[i].value;
      jacobian[i] = out[i].by;
    }
    return value;
  }

  /// Returns |δ_i|/τ_i of all unknowns, with τ_i = rtol_i max(|u_i|, |v_i|) + atol_i.
  largest_ratio in_tolerances(const unknowns& delta, const unknowns& u, const unknowns& v) const {
    largest_ratio largest;
    for (std::size_t i = 0; i < N; ++i)
      largest.add(abs(delta[i]) / (lanes(relative_[i]) * larger(abs(u[i]), abs(v[i])) + lanes(absolute_[i])));
    return largest;
  }

 private:
  std::span<const lanes, Parameters> given() const { return std::span<const lanes, Parameters>(parameters); }

  template <class Function>
  unknowns rate(const Function& function, double t, const unknowns& u) const {
    unknowns out;
    function(t, std::span<const lanes, N>(u), given(), std::span<lanes, N>(out));
    return out;
  }

  const F* f_;
  const G* g_;
  std::array<double, N> relative_, absolute_;
};

}  // namespace ensemble_parts
/// @endcond

}  // namespace apsis
