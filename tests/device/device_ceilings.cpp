#include <apsis/device/device_ceilings.hpp>

#include <apsis/device/internal/kernels/multiply_adds.hpp>

#include <vector>

#include <gmock/gmock.h>
#include <support/tested_device.hpp>

namespace device_ceilings_test {

using kernel = apsis::kernels::multiply_adds;

/// The device does all the work: its sums are those of the host.
TEST(device_ceilings, multiply_adds_have_the_bits_of_the_host) {
  constexpr int blocks = 3, lanes = 32;
  for (const auto& on : tested_devices()) {
    apsis::stored_numbers sums(blocks * lanes, on->memory());
    const kernel::arguments of{sums.data(), 100, 0.999999, 1e-6};
    on->launch<kernel>({blocks, lanes, 0}, of);
    std::vector<double> seen(sums.size());
    on->memory().copy_to_host(sums.data(), seen.size(), seen.data());
    for (std::size_t k = 0; k < seen.size(); ++k)
      EXPECT_EQ(seen[k], kernel::sum_of(static_cast<long>(k), of)) << "lane " << k;
  }
}

/// No processor does fewer than 1e5 or more than 1e16 multiply–adds per second.
TEST(device_ceilings, are_those_of_a_processor) {
  EXPECT_THAT(apsis::multiply_adds_per_second(*tested_device()),
              testing::AllOf(testing::Gt(1e5), testing::Lt(1e16)));
  EXPECT_THAT(apsis::copy_bytes_per_second(*tested_device(), 4096),
              testing::AllOf(testing::Gt(1e4), testing::Lt(1e14)));
}

}  // namespace device_ceilings_test
