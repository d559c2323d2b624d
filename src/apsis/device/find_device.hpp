#pragma once

#include <apsis/device/device.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// A device of this machine.
struct found_device {
  std::string place;  ///< "cuda:0": kind and number
  std::string name;   ///< name of the processor
};

/// Returns the devices of this machine, without those for tests.
std::vector<found_device> found_devices();

/// Opens a device. `wanted` is "" for the first device, the number or the place of one in found_devices(), or
/// the name of a kind for tests. `process` is the number of this process on this machine. With "" or a
/// number, process p opens the p-th device after the wanted one, in cyclic order. Throws input_error with a
/// list of the devices if `wanted` names none, and what device_backend_entry::open() throws.
std::shared_ptr<device> open_device(const std::string& wanted, int process = 0);

}  // namespace apsis
