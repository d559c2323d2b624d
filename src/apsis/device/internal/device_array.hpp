#pragma once

#include <apsis/exec/memory_space.hpp>

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace apsis {

/// An array of plain values in the memory of a device.
template <class T>
class device_array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  device_array() = default;
  /// Copies values of the host. Throws std::bad_alloc.
  device_array(std::span<const T> values, const memory_space& memory)
      : numbers_((values.size_bytes() + sizeof(double) - 1) / sizeof(double), memory), size_(values.size()) {
    if (values.empty()) return;
    std::vector<double> packed(numbers_.size());
    std::memcpy(packed.data(), values.data(), values.size_bytes());
    memory.copy_from_host(packed.data(), packed.size(), numbers_.data());
  }

  const T* data() const {
    return reinterpret_cast<const T*>(numbers_.data());
  }  ///< in the memory of the device
  std::size_t size() const { return size_; }  ///< how many values

 private:
  stored_numbers numbers_;
  std::size_t size_ = 0;
};

}  // namespace apsis
