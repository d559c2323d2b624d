#pragma once

#include <apsis/device/device.hpp>

#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <vector>

/// Returns the devices on which tests compare the bits with those of the host. Usually they are teams of
/// lanes in every order. APSIS_DEVICE selects another one: "first" for the first real device, or any name
/// that open_device() accepts. The devices are opened once for all tests.
const std::vector<std::shared_ptr<apsis::device>>& tested_devices();

/// Returns the last device, for slow tests. Of teams it is the one in random order.
inline const std::shared_ptr<apsis::device>& tested_device() {
  return tested_devices().back();
}

/// Returns how many numbers these devices have copied to the host so far.
std::size_t numbers_copied_to_host();

/// Returns the names of the kernels that these devices have run so far.
const std::set<std::string>& kernels_that_ran();
