#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "apsis/exec/instruction_set.cpp"
#include <hwy/foreach_target.h>

#include <apsis/exec/instruction_set.hpp>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace apsis::HWY_NAMESPACE {

const char* name() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace apsis::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace apsis {

HWY_EXPORT(name);

std::string kernel_instruction_set() {
  return HWY_DYNAMIC_DISPATCH(name)();
}

}  // namespace apsis
#endif
