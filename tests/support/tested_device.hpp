#pragma once

#include <apsis/device/device.hpp>

#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <vector>

/// Devices on which tests compare the bits with those of the host. Usually they are teams of lanes, in every
/// order. APSIS_DEVICE names another one: "first" for the first real device, or any that open_device() opens.
/// They are opened once for all tests.
const std::vector<std::shared_ptr<apsis::device>>& tested_devices();

/// Returns the last of them, for tests that take long: of teams the one in random order.
inline const std::shared_ptr<apsis::device>& tested_device() {
  return tested_devices().back();
}

/// Returns how many numbers these devices have copied to the host so far.
std::size_t numbers_copied_to_host();

/// Returns the names of the kernels that these devices have run so far.
const std::set<std::string>& kernels_that_ran();
