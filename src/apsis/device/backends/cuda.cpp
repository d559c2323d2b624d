#include <apsis/core/errors.hpp>
#include <apsis/device/device.hpp>
#include <apsis/device/internal/driver_library.hpp>
#include <apsis/device/internal/kernel_table.hpp>

#include <array>
#include <cstdint>
#include <map>
#include <optional>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The functions of the CUDA driver that are needed, declared as in its documentation (CUDA Driver
/// API, 12.0). They return 0 on success.
struct cuda_driver {
  using address = std::uint64_t;
  using handle = void*;

  int (*init)(unsigned flags);
  int (*device_count)(int* count);
  int (*device_of)(int* device, int number);
  int (*device_name)(char* name, int length, int device);
  int (*attribute)(int* value, int attribute, int device);
  int (*total_memory)(std::size_t* bytes, int device);
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

  /// Returns the driver of this machine; nothing if it has none, or an older one without these functions.
  static const cuda_driver* find() {
    static const std::optional<cuda_driver> only = open();
    return only ? &*only : nullptr;
  }

  /// Throws io_error unless a result is success.
  void require(int result, const char* doing) const {
    if (result == 0) return;
    const char* text = nullptr;
    error_text(result, &text);
    throw io_error(
        fmt::format("the device failed while {} (CUDA error {}: {}); restart from the last checkpoint", doing,
                    result, text == nullptr ? "unknown" : text));
  }

 private:
  static std::optional<cuda_driver> open() {
    const driver_library library({"libcuda.so.1"});
    cuda_driver d{};
    const bool complete =
        library.find("cuInit", d.init) && library.find("cuDeviceGetCount", d.device_count) &&
        library.find("cuDeviceGet", d.device_of) && library.find("cuDeviceGetName", d.device_name) &&
        library.find("cuDeviceGetAttribute", d.attribute) &&
        library.find("cuDeviceTotalMem_v2", d.total_memory) &&
        library.find("cuDevicePrimaryCtxRetain", d.retain_context) &&
        library.find("cuCtxSetCurrent", d.set_context) &&
        library.find("cuDevicePrimaryCtxRelease_v2", d.release_context) &&
        library.find("cuMemGetInfo_v2", d.memory_info) && library.find("cuModuleLoadDataEx", d.load) &&
        library.find("cuModuleGetFunction", d.function_of) &&
        library.find("cuFuncSetAttribute", d.set_function) && library.find("cuMemAlloc_v2", d.allocate) &&
        library.find("cuMemFree_v2", d.release) && library.find("cuMemsetD8_v2", d.clear) &&
        library.find("cuMemcpyDtoD_v2", d.copy) && library.find("cuMemcpyHtoD_v2", d.copy_from_host) &&
        library.find("cuMemcpyDtoH_v2", d.copy_to_host) && library.find("cuLaunchKernel", d.launch) &&
        library.find("cuCtxSynchronize", d.synchronize) && library.find("cuGetErrorString", d.error_text);
    if (!complete || d.init(0) != 0) return std::nullopt;
    return d;
  }
};

class cuda_memory final : public memory_space {
 public:
  cuda_memory(const cuda_driver& driver, std::string name) : driver_(driver), name_(std::move(name)) {}

  std::string_view name() const override { return name_; }
  bool on_host() const override { return false; }
  double* allocate(std::size_t count) const override {
    cuda_driver::address memory = 0;
    constexpr int out_of_memory = 2;
    const int result = driver_.allocate(&memory, count * sizeof(double));
    if (result == out_of_memory) throw std::bad_alloc();
    driver_.require(result, "memory was allocated");
    return reinterpret_cast<double*>(memory);
  }
  void release(double* numbers, std::size_t) const noexcept override { driver_.release(place(numbers)); }
  void clear(double* numbers, std::size_t count) const override {
    driver_.require(driver_.clear(place(numbers), 0, count * sizeof(double)), "memory was cleared");
  }
  void copy(const double* from, std::size_t count, double* to) const override {
    driver_.require(driver_.copy(place(to), place(from), count * sizeof(double)), "memory was copied");
  }
  void copy_from_host(const double* host, std::size_t count, double* to) const override {
    driver_.require(driver_.copy_from_host(place(to), host, count * sizeof(double)), "data were sent to it");
  }
  void copy_to_host(const double* from, std::size_t count, double* host) const override {
    driver_.require(driver_.copy_to_host(host, place(from), count * sizeof(double)), "results were read");
  }

 private:
  static cuda_driver::address place(const double* numbers) {
    return reinterpret_cast<cuda_driver::address>(numbers);
  }
  const cuda_driver& driver_;
  std::string name_;
};

std::string name_of(const cuda_driver& driver, int number) {
  std::array<char, 128> name{};
  int place = 0;
  if (driver.device_of(&place, number) != 0 ||
      driver.device_name(name.data(), static_cast<int>(name.size()) - 1, place) != 0)
    return "unknown";
  return name.data();
}

class cuda_device final : public device {
 public:
  cuda_device(const cuda_driver& driver, int number)
      : driver_(driver), name_(name_of(driver, number)), memory_(driver, name_) {
    driver_.require(driver_.device_of(&place_, number), "it was opened");
    driver_.require(driver_.retain_context(&context_, place_), "it was opened");
    driver_.require(driver_.set_context(context_), "it was opened");
    load();
  }
  ~cuda_device() override { driver_.release_context(place_); }

  std::string name() const override { return name_; }
  const memory_space& memory() const override { return memory_; }
  std::size_t bytes() const override { return info().second; }
  std::size_t free_bytes() const override { return info().first; }

  void start(std::string_view kernel, const launch_size& size, const void* arguments, std::size_t) override {
    const cuda_driver::handle function = function_of(std::string(kernel));
    const std::size_t shared = size.shared_numbers * sizeof(double);
    constexpr int largest_shared_memory = 8;
    constexpr std::size_t without_request = std::size_t{48} << 10;
    if (shared > without_request)
      driver_.require(driver_.set_function(function, largest_shared_memory, static_cast<int>(shared)),
                      "shared memory was reserved");
    void* all[] = {const_cast<void*>(arguments)};
    driver_.require(
        driver_.launch(function, static_cast<unsigned>(size.blocks), 1, 1, static_cast<unsigned>(size.lanes),
                       1, 1, static_cast<unsigned>(shared), nullptr, all, nullptr),
        "a kernel was started");
  }
  void finish() override { driver_.require(driver_.synchronize(), "kernels ran"); }

 private:
  void load() {
    constexpr int major_version = 75, minor_version = 76;
    int major = 0, minor = 0;
    driver_.attribute(&major, major_version, place_);
    driver_.attribute(&minor, minor_version, place_);
    const device_code_object* newest = nullptr;
    for (const auto& one : device_code_objects()) {
      int of_code = 0;
      if (std::sscanf(one.processor, "sm_%d", &of_code) == 1 && of_code <= 10 * major + minor) newest = &one;
    }
    if (newest == nullptr)
      throw input_error(
          fmt::format("{} cannot run the kernels (its compute capability is {}.{}); use a device of "
                      "compute capability 7.0 or later",
                      name_, major, minor));
    const int result = driver_.load(&code_, newest->code, 0, nullptr, nullptr);
    constexpr int unsupported_version = 222;
    if (result == unsupported_version)
      throw input_error("the driver of " + name_ + " is too old for the kernels; use a newer driver");
    driver_.require(result, "kernels were loaded");
  }

  cuda_driver::handle function_of(const std::string& kernel) {
    auto& function = functions_[kernel];
    if (function == nullptr)
      driver_.require(driver_.function_of(&function, code_, kernel.c_str()), "a kernel was looked up");
    return function;
  }
  std::pair<std::size_t, std::size_t> info() const {
    std::size_t free = 0, total = 0;
    driver_.require(driver_.memory_info(&free, &total), "its memory was examined");
    return {free, total};
  }

  const cuda_driver& driver_;
  int place_ = 0;
  cuda_driver::handle context_ = nullptr, code_ = nullptr;
  std::string name_;
  cuda_memory memory_;
  std::map<std::string, cuda_driver::handle> functions_;
};

std::vector<std::string> cuda_names() {
  const cuda_driver* driver = cuda_driver::find();
  int count = 0;
  if (driver == nullptr || driver->device_count(&count) != 0) return {};
  std::vector<std::string> all;
  for (int k = 0; k < count; ++k) all.push_back(name_of(*driver, k));
  return all;
}

}  // namespace

extern const device_backend_entry device_backend_cuda;
const device_backend_entry device_backend_cuda = {.name = "cuda",
                                                  .description = "processors of NVIDIA, by their driver",
                                                  .is_real = true,
                                                  .names = cuda_names,
                                                  .open = [](int number) -> std::unique_ptr<device> {
                                                    return std::make_unique<cuda_device>(*cuda_driver::find(),
                                                                                         number);
                                                  }};

}  // namespace apsis
