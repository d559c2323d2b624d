#include <apsis/core/errors.hpp>
#include <apsis/device/device.hpp>
#include <apsis/device/internal/driven_device.hpp>
#include <apsis/device/internal/driver_calls.hpp>
#include <apsis/device/internal/kernel_table.hpp>

#include <array>
#include <cstdint>
#include <cstdio>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The required functions of the CUDA driver, declared as in its documentation (CUDA Driver API, 12.0). They
/// return 0 on success.
struct cuda_functions {
  using address = std::uint64_t;
  using handle = void*;

  int (*init)(unsigned flags);
  int (*device_count)(int* count);
  int (*device_of)(int* device, int number);
  int (*device_name)(char* name, int length, int device);
  int (*attribute)(int* value, int attribute, int device);
  int (*retain_context)(handle* context, int device);
  int (*set_context)(handle context);
  int (*release_context)(int device);
  int (*memory_info)(std::size_t* free, std::size_t* total);
  int (*load)(handle* code, const void* image, unsigned options, int* names, void** values);
  int (*function_of)(handle* function, handle code, const char* name);
  int (*set_function)(handle function, int attribute, int value);
  int (*allocate)(address* memory, std::size_t bytes);
  int (*release)(address memory);
  int (*clear)(address memory, unsigned char value, std::size_t bytes);
  int (*copy)(address to, address from, std::size_t bytes);
  int (*copy_from_host)(address to, const void* from, std::size_t bytes);
  int (*copy_to_host)(void* to, address from, std::size_t bytes);
  int (*launch)(handle function, unsigned blocks, unsigned, unsigned, unsigned lanes, unsigned, unsigned,
                unsigned shared_bytes, handle stream, void** arguments, void** extra);
  int (*synchronize)();
  int (*error_text)(int error, const char** text);

  static driver_library library() { return driver_library({"libcuda.so.1"}); }
  std::string describe(int error) const {
    const char* text = nullptr;
    error_text(error, &text);
    return fmt::format("CUDA error {}: {}", error, text == nullptr ? "unknown" : text);
  }
  /// Looks up all functions; returns false if the library lacks one.
  bool find_in(const driver_library& library) {
    return library.find("cuInit", init) && library.find("cuDeviceGetCount", device_count) &&
           library.find("cuDeviceGet", device_of) && library.find("cuDeviceGetName", device_name) &&
           library.find("cuDeviceGetAttribute", attribute) &&
           library.find("cuDevicePrimaryCtxRetain", retain_context) &&
           library.find("cuCtxSetCurrent", set_context) &&
           library.find("cuDevicePrimaryCtxRelease_v2", release_context) &&
           library.find("cuMemGetInfo_v2", memory_info) && library.find("cuModuleLoadDataEx", load) &&
           library.find("cuModuleGetFunction", function_of) &&
           library.find("cuFuncSetAttribute", set_function) && library.find("cuMemAlloc_v2", allocate) &&
           library.find("cuMemFree_v2", release) && library.find("cuMemsetD8_v2", clear) &&
           library.find("cuMemcpyDtoD_v2", copy) && library.find("cuMemcpyHtoD_v2", copy_from_host) &&
           library.find("cuMemcpyDtoH_v2", copy_to_host) && library.find("cuLaunchKernel", launch) &&
           library.find("cuCtxSynchronize", synchronize) && library.find("cuGetErrorString", error_text);
  }
};

/// The CUDA driver with the interface that driven_device requires.
class cuda_driver : public driver_calls<cuda_functions> {
 public:
  /// An open device with its kernels.
  struct context {
    context(const cuda_driver& of, int number) : driver(of) {
      driver.require(driver.call_.device_of(&device, number), "it was opened");
      driver.require(driver.call_.retain_context(&opened, device), "it was opened");
      driver.require(driver.call_.set_context(opened), "it was opened");
      code = driver.load(device, number);
    }
    ~context() { driver.call_.release_context(device); }
    context(const context&) = delete;
    context& operator=(const context&) = delete;

    const cuda_driver& driver;
    int device = 0;
    handle opened = nullptr, code = nullptr;
  };

  static const cuda_driver* find() { return only<cuda_driver>(); }

  std::string name_of(int number) const {
    std::array<char, 128> name{};
    int device = 0;
    const bool named = call_.device_of(&device, number) == 0 &&
                       call_.device_name(name.data(), static_cast<int>(name.size()) - 1, device) == 0;
    return named ? name.data() : "unknown";
  }

  void allocate(std::size_t bytes, void*& memory) const {
    cuda_functions::address place = 0;
    constexpr int out_of_memory = 2;
    const int result = call_.allocate(&place, bytes);
    if (result != out_of_memory) require(result, "memory was allocated");
    memory = reinterpret_cast<void*>(place);  // NOLINT(performance-no-int-to-ptr): addresses are integers
  }
  void release(void* memory) const noexcept { call_.release(place(memory)); }
  void clear(void* memory, std::size_t bytes) const {
    require(call_.clear(place(memory), 0, bytes), "memory was cleared");
  }
  void copy(void* to, const void* from, std::size_t bytes, copy_kind kind) const {
    const int result = kind == copy_kind::inside      ? call_.copy(place(to), place(from), bytes)
                       : kind == copy_kind::to_device ? call_.copy_from_host(place(to), from, bytes)
                                                      : call_.copy_to_host(to, place(from), bytes);
    require(result, "memory was copied");
  }

  void launch(handle function, const launch_size& size, const void* arguments, std::size_t) const {
    const std::size_t shared = size.shared_numbers * sizeof(double);
    constexpr int largest_shared_memory = 8;
    constexpr std::size_t without_request = std::size_t{48} << 10;
    if (shared > without_request)
      require(call_.set_function(function, largest_shared_memory, static_cast<int>(shared)),
              "shared memory was reserved");
    void* all[] = {const_cast<void*>(arguments)};
    require(
        call_.launch(function, static_cast<unsigned>(size.blocks), 1, 1, static_cast<unsigned>(size.lanes), 1,
                     1, static_cast<unsigned>(shared), nullptr, all, nullptr),
        "a kernel was started");
  }

 private:
  friend driver_calls;

  handle load(int device, int number) const {
    constexpr int major_version = 75, minor_version = 76, unsupported_version = 222;
    int major = 0, minor = 0;
    call_.attribute(&major, major_version, device);
    call_.attribute(&minor, minor_version, device);
    const device_code_object* newest = nullptr;
    for (const auto& one : device_code_objects()) {
      int of_code = 0;
      if (std::sscanf(one.processor, "sm_%d", &of_code) == 1 && of_code <= 10 * major + minor) newest = &one;
    }
    if (newest == nullptr)
      throw input_error(fmt::format(
          "{} cannot run the kernels (its compute capability is {}.{}, or Apsis was built without "
          "clang++-19); use a device of compute capability 7.0 or later",
          name_of(number), major, minor));
    handle code = nullptr;
    const int result = call_.load(&code, newest->code, 0, nullptr, nullptr);
    if (result == unsupported_version)
      throw input_error("the driver of " + name_of(number) +
                        " is too old for the kernels (it does not know their PTX); use a newer driver");
    require(result, "kernels were loaded");
    return code;
  }

  static cuda_functions::address place(const void* memory) {
    return reinterpret_cast<cuda_functions::address>(memory);
  }
};

}  // namespace

extern const device_backend_entry device_backend_cuda;
const device_backend_entry device_backend_cuda = {.name = "cuda",
                                                  .description = "processors of NVIDIA, by their driver",
                                                  .is_real = true,
                                                  .names = driven_device<cuda_driver>::names,
                                                  .open = driven_device<cuda_driver>::open};

}  // namespace apsis
