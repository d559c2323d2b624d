// The comparisons of a device with the host run every kernel.
#include <apsis/device/internal/kernel_table.hpp>

#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <support/tested_device.hpp>

namespace every_kernel_test {
namespace {

/// Checks after the whole suite that every kernel ran. The suite must run on one device in
/// one process (tests/device/check.sh).
class kernels_of_the_suite : public testing::Environment {
 public:
  void SetUp() override { whole_ = std::getenv("APSIS_DEVICE") != nullptr && GTEST_FLAG_GET(filter) == "*"; }
  void TearDown() override {
    if (!whole_) return;
    for (const auto& kernel : apsis::host_kernels())
      EXPECT_TRUE(kernels_that_ran().contains(kernel.name)) << kernel.name << " was not compared";
  }

 private:
  bool whole_ = false;
};

[[maybe_unused]] const auto* const here = testing::AddGlobalTestEnvironment(new kernels_of_the_suite);

}  // namespace
}  // namespace every_kernel_test
