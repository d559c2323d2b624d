#pragma once

#include <apsis/device/device.hpp>
#include <apsis/device/internal/device_number.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// Direction of a copy.
enum class copy_kind { to_device, to_host, inside };

/// Memory of a device, implemented with functions of its `Driver`:
///   allocate(bytes, memory)         memory ← an address, null if there is not enough
///   release(memory), clear(memory, bytes), copy(to, from, bytes, kind)
template <class Driver>
class driver_memory final : public memory_space {
 public:
  driver_memory(const Driver& driver, std::string name) : driver_(driver), name_(std::move(name)) {}

  std::string_view name() const override { return name_; }
  bool on_host() const override { return false; }
  double* allocate(std::size_t count) const override {
    void* memory = nullptr;
    driver_.allocate(count * sizeof(double), memory);
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<double*>(memory);
  }
  void release(double* numbers, std::size_t) const noexcept override { driver_.release(numbers); }
  void clear(double* numbers, std::size_t count) const override {
    driver_.clear(numbers, count * sizeof(double));
  }
  void copy(const double* from, std::size_t count, double* to) const override {
    driver_.copy(to, from, count * sizeof(double), copy_kind::inside);
  }
  void copy_from_host(const double* host, std::size_t count, double* to) const override {
    driver_.copy(to, host, count * sizeof(double), copy_kind::to_device);
  }
  void copy_to_host(const double* from, std::size_t count, double* host) const override {
    driver_.copy(host, from, count * sizeof(double), copy_kind::to_host);
  }

 private:
  const Driver& driver_;
  std::string name_;
};

/// A device, implemented with functions of its `Driver` beside those of driver_memory:
///   find()                      the driver of this machine, or null
///   count(), name_of(number)    the devices
///   context                     a type that opens device `number` with Driver, and loads the kernels
///   memory_info()               free bytes, and all
///   function_of(context, name)  a kernel
///   launch(function, size, arguments, bytes), finish()
template <class Driver>
class driven_device final : public device {
 public:
  driven_device(const Driver& driver, int number)
      : driver_(driver), name_(driver.name_of(number)), context_(driver, number), memory_(driver, name_) {}

  std::string name() const override { return name_; }
  const memory_space& memory() const override { return memory_; }
  std::size_t bytes() const override { return driver_.memory_info().second; }
  std::size_t free_bytes() const override { return driver_.memory_info().first; }
  void start(std::string_view kernel, const launch_size& size, const void* arguments,
             std::size_t bytes_of_arguments) override {
    auto& function = functions_[std::string(kernel)];
    if (function == nullptr) function = driver_.function_of(context_, std::string(kernel));
    driver_.launch(function, size, arguments, bytes_of_arguments);
  }
  void finish() override { driver_.finish(); }

  /// Returns the names of all devices.
  static std::vector<std::string> names() {
    const Driver* driver = Driver::find();
    std::vector<std::string> all;
    for (int k = 0; driver != nullptr && k < driver->count(); ++k) all.push_back(driver->name_of(k));
    return all;
  }
  /// Opens the device with this index in names(). Throws input_error for other numbers.
  static std::unique_ptr<device> open(int number) {
    const Driver* driver = Driver::find();
    require_device_number(number, driver == nullptr ? 0 : driver->count());
    return std::make_unique<driven_device>(*driver, number);
  }

 private:
  const Driver& driver_;
  std::string name_;
  typename Driver::context context_;
  driver_memory<Driver> memory_;
  std::map<std::string, typename Driver::handle> functions_;
};

}  // namespace apsis
