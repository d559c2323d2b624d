#pragma once

#include <apsis/device/device.hpp>
#include <apsis/semidiscrete/discretization.hpp>

#include <memory>
#include <string>

namespace apsis {

/// Returns finite differences whose operators run on a device, for problem_builder::with_discretization().
/// States of the problem are stored in the memory of the device (field::copy_rows()). Results have the same
/// bits as on the host.
///
///   device& card = …;
///   auto problem =
///   problem_builder(equation).on(mesh).with_reconstruction(find_reconstruction("weno5-z").make())
///                      .with_discretization(on_device(card, "weno5-z")).build();
///
/// `reconstruction` names the reconstruction of the problem. `card` must outlive the problem. build() throws
/// input_error if a kernel for the transport, the reconstruction or the collision is missing.
std::shared_ptr<const discretization> on_device(device& card, const std::string& reconstruction);

}  // namespace apsis
