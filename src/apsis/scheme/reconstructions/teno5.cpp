#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/reconstructions/teno5.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/formulas/teno5.hpp>

#include <apsis/scheme/weno5-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void edges_teno(const double* const* rows, int count, int width, double* left, double* right) {
  weno5::sweep_edges<weights_teno>(rows, count, width, left, right);
}

void outflow_teno(const double* const* rows, int count, int width, const double* forward, double* edge) {
  weno5::sweep_outflow<weights_teno>(rows, count, width, forward, edge);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <apsis/scheme/fifth_order.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

namespace apsis {
namespace {

HWY_EXPORT(edges_teno);
HWY_EXPORT(outflow_teno);

}  // namespace

extern const reconstruction_entry reconstruction_teno5;
const reconstruction_entry reconstruction_teno5 = {
    .name = "teno5",
    .description = "fifth-order TENO: linear where data are smooth, sharper at jumps",
    .source = "Fu, Hu, Adams, JCP 305 (2016) 333-359",
    .make = [] {
      return make_fifth_order({.edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(edges_teno)(of...); },
                               .outflow_edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(outflow_teno)(of...); },
                               .operations = HWY_NAMESPACE::weno5::operations<HWY_NAMESPACE::weights_teno>});
    }};

}  // namespace apsis
#endif
