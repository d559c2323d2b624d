#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/device/internal/driver_library.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace apsis {

/// The calls that drivers of all vendors have. `Functions` is a table of these calls with
///   handle                               a pointer without a type
///   library()                            the library, which may be missing
///   find_in(library)                     fills the table; false if the library lacks a function
///   init, device_count, memory_info, function_of, synchronize
///   describe(result)                     an error in words
template <class Functions>
class driver_calls {
 public:
  using handle = typename Functions::handle;

  int count() const {
    int count = 0;
    return call_.device_count(&count) == 0 ? count : 0;
  }
  std::pair<std::size_t, std::size_t> memory_info() const {
    std::size_t free = 0, total = 0;
    require(call_.memory_info(&free, &total), "its memory was examined");
    return {free, total};
  }
  template <class Context>
  handle function_of(const Context& of, const std::string& kernel) const {
    handle function = nullptr;
    require(call_.function_of(&function, of.code, kernel.c_str()), "a kernel was looked up");
    return function;
  }
  void finish() const { require(call_.synchronize(), "kernels ran"); }

 protected:
  /// Returns the only Driver of this machine; null if there is no driver, or an older one that lacks
  /// a function.
  template <class Driver>
  static const Driver* only() {
    static const std::optional<Driver> found = [] {
      Driver driver;
      const bool there = driver.call_.find_in(Functions::library()) && driver.call_.init(0) == 0;
      return there ? std::optional(driver) : std::nullopt;
    }();
    return found ? &*found : nullptr;
  }

  /// Throws io_error unless `result` is 0; the message states what failed, `doing`.
  void require(int result, const char* doing) const {
    if (result != 0)
      throw io_error(fmt::format("the device failed while {} ({}); restart from the last checkpoint", doing,
                                 call_.describe(result)));
  }

  Functions call_{};
};

}  // namespace apsis
