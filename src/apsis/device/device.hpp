#pragma once

#include <apsis/exec/memory_space.hpp>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// Size of a launch.
struct launch_size {
  int blocks = 1;                  ///< blocks of lanes
  int lanes = 1;                   ///< lanes of a block
  std::size_t shared_numbers = 0;  ///< numbers that the lanes of a block share
};

/// A processor with memory of its own that runs kernels (device/internal/lane.hpp). Launches run one after
/// the other, and return before they are complete; copies of memory() wait for them.
///
/// Every member function throws io_error if the device fails.
class device {
 public:
  device() = default;
  device(const device&) = delete;             ///< not copyable
  device& operator=(const device&) = delete;  ///< not copyable
  virtual ~device() = default;

  /// Returns the name of the processor.
  virtual std::string name() const = 0;
  /// Returns the memory of the device.
  virtual const memory_space& memory() const = 0;
  /// Returns the size of the memory in bytes.
  virtual std::size_t bytes() const = 0;
  /// Returns the number of free bytes of the memory.
  virtual std::size_t free_bytes() const = 0;
  /// Starts a kernel by its name. `arguments` are copied.
  virtual void start(std::string_view kernel, const launch_size& size, const void* arguments,
                     std::size_t bytes_of_arguments) = 0;
  /// Waits until all launches are complete.
  virtual void finish() = 0;

  /// Starts a kernel.
  template <class Kernel>
  void launch(const launch_size& size, const typename Kernel::arguments& arguments) {
    start(Kernel::name, size, &arguments, sizeof arguments);
  }
};

/// A kind of device: a file of device/backends/ defines `extern const
/// device_backend_entry device_backend_<file>`.
struct device_backend_entry {
  std::string name;         ///< "cuda"
  std::string description;  ///< one line
  bool is_real;             ///< false if the host plays the device, for tests
  /// Returns the names of all devices found; throws nothing.
  std::vector<std::string> (*names)();
  /// Opens a device by its index in names(). Throws input_error for other numbers and if the device cannot
  /// run the kernels, and io_error if it fails.
  std::unique_ptr<device> (*open)(int number);
};

/// Returns all kinds of devices, sorted by file name (generated).
std::vector<const device_backend_entry*> device_backend_entries();

}  // namespace apsis
