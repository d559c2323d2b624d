#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/array_state.hpp>
#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/jet.hpp>
#include <apsis/integrate/lane_matrix.hpp>
#include <apsis/integrate/lanes.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {

/// Counts of an ensemble, over all groups of eight systems.
struct ensemble_counts {
  long steps = 0,      ///< accepted steps
      rejected = 0,    ///< rejected steps
      solves = 0,      ///< stage solves
      iterations = 0,  ///< of Newton's method
      matrices = 0;    ///< Jacobian matrices, each with its factors
};

/// @cond
namespace ensemble_parts {

/// u' = F(t, u, p) + G(t, u, p) for eight systems: unknown i of lane k is number 8 i + k of the state.
template <std::size_t N, std::size_t Parameters, class F, class G>
class lane_problem {
 public:
  using state = std::vector<double>;
  using real = double;

  lane_problem(const F& f, const G& g, const component_tolerances<double>& tolerances) : f_(&f), g_(&g) {
    for (std::size_t i = 0; i < N; ++i) {
      relative_[i] = tolerances.relative(i);
      absolute_[i] = tolerances.absolute(i);
    }
  }

  std::array<lanes, Parameters>& parameters() { return parameters_; }
  ensemble_counts& counts() { return counts_; }

  void add_transport(double t, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& { return evaluate(*f_, t, u); });
  }
  void add_collision(double t, const state& u, std::span<const target<state, double>> targets) {
    accumulate<state>(targets, u, [&]() -> const state& { return evaluate(*g_, t, u); });
  }
  bool has_transport(double t, const state& u) { return !is_zero(evaluate(*f_, t, u)); }
  double forward_euler_step(double, const state&) const { return std::numeric_limits<double>::infinity(); }

  /// Solves a stage by Newton's method. The matrix of an earlier iteration is kept while corrections shrink
  /// eightfold. The iteration ends with a correction of at most a thousandth of the tolerance, because
  /// extrapolation multiplies errors of solves by up to 300.
  void solve_collision(double t, double a, double, state& u) {
    if (a == 0.0) return;
    ++counts_.solves;
    const unknowns explicit_part = read(u);
    unknowns v = explicit_part;
    bool renew = true;
    double before = std::numeric_limits<double>::infinity();
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      ++counts_.iterations;
      unknowns rate;
      if (renew)
        rate = renew_matrix(t, a, v);
      else
        (*g_)(t, std::span<const lanes, N>(v), parameters_view(), std::span<lanes, N>(rate));
      for (std::size_t i = 0; i < N; ++i) rate[i] = (explicit_part[i] - v[i]) + lanes(a) * rate[i];
      matrix_.solve(rate);
      for (std::size_t i = 0; i < N; ++i) v[i] += rate[i];
      const double size = size_of(rate, v);
      if (size <= 1e-3) return write(v, u);
      if (!(size < std::numeric_limits<double>::infinity())) throw_not_finite(v);
      renew = size > before / 8.0;
      before = size;
    }
    throw numerical_error(
        "Newton's method does not solve a stage (the step is too long for the curvature of the collision); "
        "reduce the step");
  }

  /// Returns the largest difference of two states in units of the tolerances.
  double distance(const state& u, const state& v) const {
    largest_ratio largest;
    for (std::size_t i = 0; i < N; ++i) {
      const lanes x = lanes::load(&u[i * lanes::count]), y = lanes::load(&v[i * lanes::count]);
      largest.add(abs(x - y) / (lanes(relative_[i]) * larger(abs(x), abs(y)) + lanes(absolute_[i])));
    }
    return largest.of_all();
  }

 private:
  using unknowns = std::array<lanes, N>;
  static constexpr int most_iterations = 50;

  std::span<const lanes, Parameters> parameters_view() const {
    return std::span<const lanes, Parameters>(parameters_);
  }

  static unknowns read(const state& u) {
    unknowns v;
    for (std::size_t i = 0; i < N; ++i) v[i] = lanes::load(&u[i * lanes::count]);
    return v;
  }
  static void write(const unknowns& v, state& u) {
    for (std::size_t i = 0; i < N; ++i) v[i].store(&u[i * lanes::count]);
  }
  /// The largest of ratios ≥ 0 in all lanes, NaN if one is not finite.
  class largest_ratio {
   public:
    void add(const lanes& ratio) {
      largest_ = larger(largest_, ratio);
      doubt_ += ratio - ratio;  // 0, or NaN
    }
    double of_all() const {
      const lanes all = largest_ + doubt_;
      double largest = all[0];
      for (std::size_t k = 1; k < lanes::count; ++k)
        if (!(all[k] <= largest)) largest = all[k];
      return largest;
    }

   private:
    lanes largest_ = 0.0, doubt_ = 0.0;
  };

  template <class Function>
  const state& evaluate(const Function& function, double t, const state& u) {
    const unknowns v = read(u);
    unknowns out;
    function(t, std::span<const lanes, N>(v), parameters_view(), std::span<lanes, N>(out));
    work_.resize(u.size());
    write(out, work_);
    return work_;
  }

  /// Returns G(t, v), and sets the factors of I − a G'.
  unknowns renew_matrix(double t, double a, const unknowns& v) {
    ++counts_.matrices;
    std::array<jet<N>, N> in, out;
    for (std::size_t i = 0; i < N; ++i) {
      in[i] = jet<N>(v[i]);
      in[i].by[i] = 1.0;
    }
    (*g_)(t, std::span<const jet<N>, N>(in), parameters_view(), std::span<jet<N>, N>(out));
    unknowns rate;
    for (std::size_t i = 0; i < N; ++i) {
      rate[i] = out[i].value;
      for (std::size_t j = 0; j < N; ++j) matrix_(i, j) = lanes(-a) * out[i].by[j];
      matrix_(i, i) += 1.0;
    }
    matrix_.factorize();
    return rate;
  }

  double size_of(const unknowns& correction, const unknowns& v) const {
    largest_ratio largest;
    for (std::size_t i = 0; i < N; ++i)
      largest.add(abs(correction[i]) / (lanes(relative_[i]) * abs(v[i]) + lanes(absolute_[i])));
    return largest.of_all();
  }

  [[noreturn]] static void throw_not_finite(const unknowns& v) {
    for (std::size_t k = 0; k < lanes::count; ++k)
      for (std::size_t i = 0; i < N; ++i)
        if (!std::isfinite(v[i][k]))
          throw numerical_error(
              "a stage is not finite (its matrix is singular, or the collision is not); "
              "reduce the step, or check the data",
              {-1, std::numeric_limits<double>::quiet_NaN(), static_cast<long>(k), v[i][k]});
    throw numerical_error("a correction of a stage is not finite (its matrix is singular); reduce the step");
  }

  const F* f_;
  const G* g_;
  std::array<lanes, Parameters> parameters_;
  std::array<double, N> relative_, absolute_;
  lane_matrix<N> matrix_;
  ensemble_counts counts_;
  state work_;
};

inline void require_ensemble_method(const method& m) {
  const auto form = m.coefficients<double>();
  const bool second = std::any_of(form.ddot.begin(), form.ddot.end(), [](double x) { return x != 0.0; });
  if (second || solves_exactly(m.kind))
    throw input_error(
        "method '" + m.name +
        "' has second derivatives or exact collisions (stages in lanes have neither); choose one "
        "without, such as extrapolated-euler-5 or ark-436");
}

}  // namespace ensemble_parts
/// @endcond

/// T = 0 of an ensemble.
struct no_lane_transport {
  /// out ← 0
  template <class U, class P, class Out>
  void operator()(double, const U&, const P&, const Out& out) const {
    for (auto& x : out) x = 0.0;
  }
};

/// Integrates many systems u' = F(t, u, p) + G(t, u, p) of N unknowns each from t0 to t1, such as the cells
/// of a reacting flow or of a plasma. Eight systems advance side by side in the lanes of vectors. F is
/// explicit and G implicit. All quantities are dimensionless.
///   u            N numbers of each system, one system after the other; replaced by those at t1
///   parameters   Parameters numbers of each system, in the same order
///   f, g         called as g(t, u, p, out) for eight systems. u and out are spans of N `lanes` or `jet<N>`,
///                p is a span of lanes; [](double, auto u, auto p, auto out) { … } accepts all of them. They
///                must not branch on numbers. f is called with lanes only
/// Steps keep the estimated error of every unknown of every system below its tolerance. The systems of a
/// group share their steps. A system therefore depends, within its tolerance, on the seven others of its
/// group, and on no other system. Different threads may integrate disjoint parts of an ensemble. If the parts
/// are multiples of eight systems, the results are bitwise those of the whole. Stages are solved by Newton's
/// method with exact derivatives (jets), to a thousandth of the tolerance. The method has no second
/// derivatives: extrapolated-euler-S, ark-436, ars-443, ….
///
/// Throws input_error for another method, for numbers that do not fit together or are not finite, and for t1
/// < t0. Throws numerical_error with the number of a system as the cell if its steps fail. Systems before its
/// group are then at t1, the others at t0.
template <std::size_t N, std::size_t Parameters = 0, class F, class G>
ensemble_counts integrate_ensemble(const method& m, const F& f, const G& g, std::span<double> u,
                                   std::span<const double> parameters, double t0, double t1,
                                   const component_tolerances<double>& tolerances) {
  ensemble_parts::require_ensemble_method(m);
  const std::size_t systems = u.size() / N;
  if (systems * N != u.size() || parameters.size() != systems * Parameters)
    throw input_error(
        fmt::format("{} unknowns and {} parameters do not fit (a system has {} and {}); give the same "
                    "number of systems for both",
                    u.size(), parameters.size(), N, Parameters));
  const auto bad = std::find_if(u.begin(), u.end(), [](double x) { return !std::isfinite(x); });
  if (bad != u.end())
    throw input_error(fmt::format("unknown {} of system {} is not finite (steps begin there); give numbers",
                                  (bad - u.begin()) % static_cast<std::ptrdiff_t>(N),
                                  (bad - u.begin()) / static_cast<std::ptrdiff_t>(N)));
  ensemble_parts::lane_problem<N, Parameters, F, G> problem(f, g, tolerances);
  stepper march(m, problem, solutions::result_and_embedded);
  const auto distance = [&problem](const auto& x, const auto& y) { return problem.distance(x, y); };
  std::vector<double> group(N * lanes::count);
  for (std::size_t first = 0; first < systems; first += lanes::count) {
    // Lanes beyond the last system repeat it.
    const auto system = [&](std::size_t k) { return std::min(first + k, systems - 1); };
    const auto gather = [&](std::span<const double> from, std::size_t n, std::size_t i) {
      double all[lanes::count];
      for (std::size_t k = 0; k < lanes::count; ++k) all[k] = from[system(k) * n + i];
      return lanes::load(all);
    };
    for (std::size_t i = 0; i < N; ++i) gather(u, N, i).store(&group[i * lanes::count]);
    for (std::size_t i = 0; i < Parameters; ++i) problem.parameters()[i] = gather(parameters, Parameters, i);
    step_controller<double> control(1.0, estimate_of(m).order);
    try {
      problem.counts().steps +=
          integrate_to_tolerance(march, group, t0, t1, step_rule<double>::unlimited(), control, distance)
              .steps;
    } catch (const numerical_error& failure) {
      failure_site site = failure.site();
      site.cell = static_cast<long>(system(static_cast<std::size_t>(std::max(site.cell, 0L))));
      throw numerical_error(failure.problem(), site);
    }
    problem.counts().rejected += control.rejected();
    for (std::size_t k = 0; k < lanes::count && first + k < systems; ++k)
      for (std::size_t i = 0; i < N; ++i) u[(first + k) * N + i] = group[i * lanes::count + k];
  }
  return problem.counts();
}

}  // namespace apsis
