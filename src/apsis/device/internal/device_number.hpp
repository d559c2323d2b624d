#pragma once

#include <apsis/core/errors.hpp>

#include <fmt/format.h>

namespace apsis {

/// Throws input_error unless 0 ≤ number < count, the number of devices.
inline void require_device_number(int number, int count) {
  if (count == 0)
    throw input_error("no device was found (this machine has no driver of one); run without --device");
  if (number < 0 || number >= count)
    throw input_error(
        fmt::format("no device {} (devices have the numbers 0 to {}); give one of these", number, count - 1));
}

}  // namespace apsis
