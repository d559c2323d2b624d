#pragma once

#include <apsis/device/device.hpp>
#include <apsis/device/internal/device_array.hpp>
#include <apsis/device/internal/gas_rows.hpp>
#include <apsis/model/gas.hpp>

#include <string>

namespace apsis {

/// Arguments of kernels that describe the rows of a gas, in the memory of a device.
class device_gas_rows {
 public:
  /// `on` and `molecules` must outlive the object. Kernels must support the gas: why_not() returns "".
  device_gas_rows(const device& on, const gas& molecules);

  /// Returns why kernels do not support the rows of a gas, as a clause; "" if they do.
  static std::string why_not(const gas& molecules);

  /// Returns the numbers of view(), without its pointers.
  static kernels::gas_rows shape(const gas& molecules);
  /// Returns the arguments of kernels. Their pointers are valid as long as this object lives.
  kernels::gas_rows view() const;

 private:
  const gas& gas_;
  device_array<double> v_, quadrature_, functions_, weights_;
};

}  // namespace apsis
