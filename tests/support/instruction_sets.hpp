#pragma once

#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

/// Runs body() with the kernels of every instruction set that is built and supported by this processor,
/// including the baseline. Restores the best one afterwards.
template <class Body>
void for_each_instruction_set(const Body& body) {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
}
