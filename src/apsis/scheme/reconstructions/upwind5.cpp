#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/reconstructions/upwind5.cpp"
#include <hwy/foreach_target.h>

#include <apsis/exec/counted.hpp>
#include <apsis/scheme/formulas/upwind.hpp>
#include <apsis/scheme/walk-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

template <class Walk>
HWY_INLINE auto edge_of(const Walk& way, const double* const* rows, int j) {
  return upwind5_edge(way.load(rows, j - 2), way.load(rows, j - 1), way.load(rows, j), way.load(rows, j + 1),
                      way.load(rows, j + 2));
}

void outflow_edges(const double* const* rows, int count, int width, const double* forward, double* edge) {
  for_walks(forward, count, width, [&](const auto& way, int) APSIS_PACKED {
    for (int j = 0; j < count; ++j) way.store(edge_of(way, rows, j), edge, width, j);
  });
}

void edges(const double* const* rows, int count, int width, double* left, double* right) {
  for_packs(width, [&](auto lanes, int k) APSIS_PACKED {
    using D = decltype(lanes);
    const walk<course::forward, D> to_right(count, k, nullptr);
    const walk<course::backward, D> to_left(count, k, nullptr);
    for (int j = 0; j < count; ++j) {
      to_right.store(edge_of(to_right, rows, j), right, width, j);
      to_left.store(edge_of(to_left, rows, j), left, width, j);
    }
  });
}

double operations_of_edge() {
  const counted x(0.0);
  return counted::operations_of([&] { upwind5_edge(x, x, x, x, x); });
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <apsis/scheme/fifth_order.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

namespace apsis {
namespace {

HWY_EXPORT(edges);
HWY_EXPORT(outflow_edges);

}  // namespace

/// The linear scheme that WENO approaches on smooth data, without protection against oscillations. Its fluxes
/// û reproduce linear functions. For data that vanish at the ends of a line, Σ û_{i+1/2} = Σ u_i and Σ
/// x_{i+1/2} û_{i+1/2} = Σ x_i u_i.
extern const reconstruction_entry reconstruction_upwind5;
const reconstruction_entry reconstruction_upwind5 = {
    .name = "upwind5",
    .description = "fifth-order linear upwind: for smooth solutions, without protection against oscillations",
    .source = "the linear weights of Jiang, Shu, JCP 126 (1996)",
    .linear = true,
    .make = [] {
      return make_fifth_order(
          {.edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(edges)(of...); },
           .outflow_edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(outflow_edges)(of...); },
           .operations =
               [](bool both_edges) {
                 return (both_edges ? 2.0 : 1.0) * HWY_NAMESPACE::operations_of_edge();
               }});
    }};

}  // namespace apsis
#endif
