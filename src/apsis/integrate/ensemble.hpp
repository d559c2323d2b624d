#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/integrate/component_tolerances.hpp>
#include <apsis/integrate/lane_newton-inl.hpp>
#include <apsis/integrate/lane_system.hpp>
#include <apsis/integrate/lanes.hpp>
#include <apsis/integrate/linearly_implicit.hpp>
#include <apsis/method/method.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <fmt/format.h>

namespace apsis {

/// @cond
namespace ensemble_parts {

/// Throws input_error unless the numbers of systems fit together and all unknowns are finite.
template <std::size_t N, std::size_t Parameters>
void require_systems(std::span<const double> u, std::span<const double> parameters) {
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
}

/// Integrates all groups of eight systems, one after the other: advance(system, u, t0, t1) integrates one.
template <std::size_t N, std::size_t Parameters, class System, class Advance>
ensemble_counts by_groups(System& system, Advance&& advance, std::span<double> u,
                          std::span<const double> parameters, double t0, double t1) {
  require_systems<N, Parameters>(u, parameters);
  const std::size_t systems = u.size() / N;
  for (std::size_t first = 0; first < systems; first += lanes::count) {
    // Lanes beyond the last system repeat it.
    const auto member = [&](std::size_t k) { return std::min(first + k, systems - 1); };
    const auto gather = [&](std::span<const double> from, std::size_t n, std::size_t i) {
      double all[lanes::count];
      for (std::size_t k = 0; k < lanes::count; ++k) all[k] = from[member(k) * n + i];
      return lanes::load(all);
    };
    typename System::unknowns group;
    for (std::size_t i = 0; i < N; ++i) group[i] = gather(u, N, i);
    for (std::size_t i = 0; i < Parameters; ++i) system.parameters[i] = gather(parameters, Parameters, i);
    try {
      advance(system, group, t0, t1);
    } catch (const numerical_error& failure) {
      failure_site site = failure.site();
      site.cell = static_cast<long>(member(static_cast<std::size_t>(std::max(site.cell, 0L))));
      throw numerical_error(failure.problem(), site);
    }
    for (std::size_t k = 0; k < lanes::count && first + k < systems; ++k)
      for (std::size_t i = 0; i < N; ++i) u[(first + k) * N + i] = group[i][k];
  }
  return system.counts;
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
/// are multiples of eight systems, the results are bitwise those of the whole.
///
/// Throws input_error for an order outside 2 to 8, for numbers that do not fit together or are not finite,
/// and for t1 < t0. Throws numerical_error with the number of a system as the cell if its steps fail. Systems
/// before its group are then at t1, the others at t0.
template <std::size_t N, std::size_t Parameters = 0, class F, class G>
ensemble_counts integrate_ensemble(const linearly_implicit& steps, const F& f, const G& g,
                                   std::span<double> u, std::span<const double> parameters, double t0,
                                   double t1, const component_tolerances<double>& tolerances) {
  using system_type = ensemble_parts::lane_system<N, Parameters, F, G>;
  double rtol = tolerances.relative(0);
  for (std::size_t i = 1; i < N; ++i) rtol = std::min(rtol, tolerances.relative(i));
  system_type system(f, g, tolerances);
  ensemble_parts::linear_steps<system_type> advance(ensemble_parts::order_of(steps, rtol));
  return ensemble_parts::by_groups<N, Parameters>(system, advance, u, parameters, t0, t1);
}

/// Integrates many systems by the steps of a method, with everything else as above. Stages are solved by
/// Newton's method with exact derivatives (jets), to a thousandth of the tolerance. The method has no second
/// derivatives: ark-436, ars-443, extrapolated-euler-S, …. Throws input_error for another method.
template <std::size_t N, std::size_t Parameters = 0, class F, class G>
ensemble_counts integrate_ensemble(const method& m, const F& f, const G& g, std::span<double> u,
                                   std::span<const double> parameters, double t0, double t1,
                                   const component_tolerances<double>& tolerances) {
  using system_type = ensemble_parts::lane_system<N, Parameters, F, G>;
  ensemble_parts::require_ensemble_method(m);
  system_type system(f, g, tolerances);
  ensemble_parts::newton_steps<system_type> advance(m, system);
  return ensemble_parts::by_groups<N, Parameters>(system, advance, u, parameters, t0, t1);
}

}  // namespace apsis
