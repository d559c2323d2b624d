#include <apsis/core/errors.hpp>
#include <apsis/device/device.hpp>
#include <apsis/device/internal/driven_device.hpp>
#include <apsis/device/internal/driver_calls.hpp>
#include <apsis/device/internal/kernel_table.hpp>

#include <array>
#include <string_view>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The required functions of the HIP runtime, declared as in its documentation (HIP 5.0). They return 0
/// on success.
struct hip_functions {
  using handle = void*;

  int (*init)(unsigned flags);
  int (*device_count)(int* count);
  int (*device_name)(char* name, int length, int device);
  int (*set_device)(int device);
  int (*memory_info)(std::size_t* free, std::size_t* total);
  int (*load)(handle* code, const void* image);
  int (*function_of)(handle* function, handle code, const char* name);
  int (*allocate)(void** memory, std::size_t bytes);
  int (*release)(void* memory);
  int (*clear)(void* memory, int value, std::size_t bytes);
  int (*copy)(void* to, const void* from, std::size_t bytes, int kind);
  int (*launch)(handle function, unsigned blocks, unsigned, unsigned, unsigned lanes, unsigned, unsigned,
                unsigned shared_bytes, handle stream, void** arguments, void** extra);
  int (*synchronize)();
  const char* (*error_text)(int error);

  static driver_library library() {
    return driver_library({"libamdhip64.so", "libamdhip64.so.7", "libamdhip64.so.6", "libamdhip64.so.5"});
  }
  std::string describe(int error) const { return fmt::format("HIP error {}: {}", error, error_text(error)); }
  /// Looks up all functions; returns false if the library lacks one.
  bool find_in(const driver_library& library) {
    return library.find("hipInit", init) && library.find("hipGetDeviceCount", device_count) &&
           library.find("hipDeviceGetName", device_name) && library.find("hipSetDevice", set_device) &&
           library.find("hipMemGetInfo", memory_info) && library.find("hipModuleLoadData", load) &&
           library.find("hipModuleGetFunction", function_of) && library.find("hipMalloc", allocate) &&
           library.find("hipFree", release) && library.find("hipMemset", clear) &&
           library.find("hipMemcpy", copy) && library.find("hipModuleLaunchKernel", launch) &&
           library.find("hipDeviceSynchronize", synchronize) && library.find("hipGetErrorString", error_text);
  }
};

/// The HIP runtime with the interface that driven_device requires.
class hip_driver : public driver_calls<hip_functions> {
 public:
  /// An open device with its kernels.
  struct context {
    context(const hip_driver& driver, int number) {
      driver.require(driver.call_.set_device(number), "it was opened");
      // The runtime loads only code for the processor of the device.
      for (const auto& one : device_code_objects())
        if (std::string_view(one.processor).starts_with("gfx") && driver.call_.load(&code, one.code) == 0)
          return;
      throw input_error(driver.name_of(number) +
                        " cannot run the kernels (there is no code for it); use a gfx90a or gfx942");
    }

    handle code = nullptr;
  };

  static const hip_driver* find() { return only<hip_driver>(); }

  std::string name_of(int number) const {
    std::array<char, 128> name{};
    const bool named = call_.device_name(name.data(), static_cast<int>(name.size()) - 1, number) == 0;
    return named ? name.data() : "unknown";
  }

  void allocate(std::size_t bytes, void*& memory) const {
    constexpr int out_of_memory = 2;
    const int result = call_.allocate(&memory, bytes);
    if (result == out_of_memory)
      memory = nullptr;
    else
      require(result, "memory was allocated");
  }
  void release(void* memory) const noexcept { call_.release(memory); }
  void clear(void* memory, std::size_t bytes) const {
    require(call_.clear(memory, 0, bytes), "memory was cleared");
  }
  void copy(void* to, const void* from, std::size_t bytes, copy_kind kind) const {
    constexpr int to_device = 1, to_host = 2, inside = 3;
    const int direction = kind == copy_kind::inside      ? inside
                          : kind == copy_kind::to_device ? to_device
                                                         : to_host;
    require(call_.copy(to, from, bytes, direction), "memory was copied");
  }

  void launch(handle function, const launch_size& size, const void* arguments, std::size_t bytes) const {
    // In the runtime, 1 marks a buffer with all arguments, 2 its size, and 3 the end of the list.
    void* extra[] = {reinterpret_cast<void*>(1), const_cast<void*>(arguments), reinterpret_cast<void*>(2),
                     &bytes, reinterpret_cast<void*>(3)};
    require(
        call_.launch(function, static_cast<unsigned>(size.blocks), 1, 1, static_cast<unsigned>(size.lanes), 1,
                     1, static_cast<unsigned>(size.shared_numbers * sizeof(double)), nullptr, nullptr, extra),
        "a kernel was started");
  }

 private:
  friend driver_calls;
};

}  // namespace

extern const device_backend_entry device_backend_hip;
const device_backend_entry device_backend_hip = {.name = "hip",
                                                 .description = "processors of AMD, by their runtime",
                                                 .is_real = true,
                                                 .names = driven_device<hip_driver>::names,
                                                 .open = driven_device<hip_driver>::open};

}  // namespace apsis
