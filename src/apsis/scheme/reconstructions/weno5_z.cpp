#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/reconstructions/weno5_z.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/formulas/weno5_z.hpp>

#include <apsis/scheme/weno5-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void edges_z(const double* const* rows, int count, int width, double* left, double* right) {
  weno5::sweep_edges<weights_z>(rows, count, width, left, right);
}

void outflow_z(const double* const* rows, int count, int width, const double* forward, double* edge) {
  weno5::sweep_outflow<weights_z>(rows, count, width, forward, edge);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <apsis/scheme/fifth_order.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

namespace apsis {
namespace {

HWY_EXPORT(edges_z);
HWY_EXPORT(outflow_z);

}  // namespace

extern const reconstruction_entry reconstruction_weno5_z;
const reconstruction_entry reconstruction_weno5_z = {
    .name = "weno5-z",
    .description = "fifth-order WENO with Z weights: full order at smooth extrema",
    .source = "Borges, Carmona, Costa, Don, JCP 227 (2008) 3191-3211",
    .make = [] {
      return make_fifth_order({.edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(edges_z)(of...); },
                               .outflow_edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(outflow_z)(of...); },
                               .operations = HWY_NAMESPACE::weno5::operations<HWY_NAMESPACE::weights_z>});
    }};

}  // namespace apsis
#endif
