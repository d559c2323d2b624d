#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/reconstructions/weno5_z_smooth.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/formulas/weno5_z.hpp>
#include <apsis/scheme/weno5-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void edges_z_smooth(const double* const* rows, int count, int width, double* left, double* right) {
  weno5::sweep_edges<weights_z_smooth>(rows, count, width, left, right);
}

void outflow_z_smooth(const double* const* rows, int count, int width, const double* forward, double* edge) {
  weno5::sweep_outflow<weights_z_smooth>(rows, count, width, forward, edge);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <apsis/scheme/fifth_order.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

namespace apsis {
namespace {

HWY_EXPORT(edges_z_smooth);
HWY_EXPORT(outflow_z_smooth);

}  // namespace

extern const reconstruction_entry reconstruction_weno5_z_smooth;
const reconstruction_entry reconstruction_weno5_z_smooth = {
    .name = "weno5-z-smooth",
    .description = "weno5-z that takes jumps by less than the value as smooth: for steady states",
    .source = "Borges, Carmona, Costa, Don, JCP 227 (2008) 3191-3211",
    .settles = true,
    .make = [] {
      return make_fifth_order(
          {.edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(edges_z_smooth)(of...); },
           .outflow_edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(outflow_z_smooth)(of...); },
           .operations = HWY_NAMESPACE::weno5::operations<HWY_NAMESPACE::weights_z_smooth>});
    }};

}  // namespace apsis
#endif
