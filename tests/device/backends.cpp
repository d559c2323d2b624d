// Kinds of devices, whether or not this machine has one.
#include <apsis/core/errors.hpp>
#include <apsis/device/device.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace device_backends_test {

using testing::HasSubstr;

TEST(device_backends, refuse_numbers_of_devices_that_do_not_exist) {
  for (const apsis::device_backend_entry* kind : apsis::device_backend_entries()) {
    const auto count = static_cast<int>(kind->names().size());
    for (const int number : {-1, count, count + 7})
      EXPECT_THAT(
          [&] { kind->open(number); },
          testing::ThrowsMessage<apsis::input_error>(HasSubstr(
              count == 0 ? "no device was found" : fmt::format("no device {} (devices have", number))))
          << kind->name;
  }
}

}  // namespace device_backends_test
