#pragma once

#include <apsis/study/claim_registry.hpp>

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

/// Checks a claim as the program does, prints what was measured, and fails with the findings that do not
/// hold.
inline void expect_claim(const std::string& id) {
  const auto result = apsis::find_claims({id}).at(0)->check({});
  EXPECT_FALSE(result.findings.empty());
  for (const auto& f : result.findings) {
    std::printf("  %s: %.6g (%s)\n", f.what.c_str(), f.value, f.condition.c_str());
    EXPECT_TRUE(f.holds) << id << ": " << f.what << " is " << f.value << ", must be " << f.condition;
  }
}
