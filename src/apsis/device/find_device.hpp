#pragma once

#include <apsis/device/device.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// A device of this machine.
struct found_device {
  std::string place;  ///< "cuda:0": kind and number
  std::string name;   ///< of the processor
};

/// Returns the devices of this machine; those of tests are not among them.
std::vector<found_device> found_devices();

/// Opens a device: the first one by "", one of found_devices() by its number there or its place, or one of a
/// kind for tests by its name. `process`: the number of this process among those of the machine; so many
/// devices behind the one of a number is that of the process, in turn. Throws input_error with those that
/// there are, and what device_backend_entry::open() throws.
std::shared_ptr<device> open_device(const std::string& wanted, int process = 0);

}  // namespace apsis
