#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/scheme/reconstructions/weno5_js.cpp"
#include <hwy/foreach_target.h>

#include <apsis/scheme/formulas/weno5_js.hpp>

#include <apsis/scheme/weno5-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

void edges_js(const double* const* rows, int count, int width, double* left, double* right) {
  weno5::sweep_edges<weights_js>(rows, count, width, left, right);
}

void outflow_js(const double* const* rows, int count, int width, const double* forward, double* edge) {
  weno5::sweep_outflow<weights_js>(rows, count, width, forward, edge);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <apsis/scheme/fifth_order.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

namespace apsis {
namespace {

HWY_EXPORT(edges_js);
HWY_EXPORT(outflow_js);

}  // namespace

extern const reconstruction_entry reconstruction_weno5_js;
const reconstruction_entry reconstruction_weno5_js = {
    .name = "weno5-js",
    .description = "fifth-order WENO with the weights of Jiang and Shu",
    .source = "Jiang, Shu, JCP 126 (1996) 202-228",
    .make = [] {
      return make_fifth_order({.edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(edges_js)(of...); },
                               .outflow_edges = [](auto... of) { HWY_DYNAMIC_DISPATCH(outflow_js)(of...); },
                               .operations = HWY_NAMESPACE::weno5::operations<HWY_NAMESPACE::weights_js>});
    }};

}  // namespace apsis
#endif
