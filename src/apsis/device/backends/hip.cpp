#include <apsis/core/errors.hpp>
#include <apsis/device/device.hpp>
#include <apsis/device/internal/driver_library.hpp>
#include <apsis/device/internal/kernel_table.hpp>

#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// The functions of the HIP runtime that are needed, declared as in its documentation (HIP 5.0). They return
/// 0 on success.
struct hip_driver {
  using handle = void*;
  static constexpr int to_device = 1, to_host = 2, inside = 3;  ///< kinds of copies

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

  /// Returns the runtime of this machine; nothing if it has none.
  static const hip_driver* find() {
    static const std::optional<hip_driver> only = open();
    return only ? &*only : nullptr;
  }

  /// Throws io_error unless a result is success.
  void require(int result, const char* doing) const {
    if (result == 0) return;
    throw io_error(
        fmt::format("the device failed while {} (HIP error {}: {}); restart from the last checkpoint", doing,
                    result, error_text(result)));
  }

 private:
  static std::optional<hip_driver> open() {
    const driver_library library(
        {"libamdhip64.so", "libamdhip64.so.7", "libamdhip64.so.6", "libamdhip64.so.5"});
    hip_driver d{};
    const bool complete =
        library.find("hipInit", d.init) && library.find("hipGetDeviceCount", d.device_count) &&
        library.find("hipDeviceGetName", d.device_name) && library.find("hipSetDevice", d.set_device) &&
        library.find("hipMemGetInfo", d.memory_info) && library.find("hipModuleLoadData", d.load) &&
        library.find("hipModuleGetFunction", d.function_of) && library.find("hipMalloc", d.allocate) &&
        library.find("hipFree", d.release) && library.find("hipMemset", d.clear) &&
        library.find("hipMemcpy", d.copy) && library.find("hipModuleLaunchKernel", d.launch) &&
        library.find("hipDeviceSynchronize", d.synchronize) &&
        library.find("hipGetErrorString", d.error_text);
    if (!complete || d.init(0) != 0) return std::nullopt;
    return d;
  }
};

class hip_memory final : public memory_space {
 public:
  hip_memory(const hip_driver& driver, std::string name) : driver_(driver), name_(std::move(name)) {}

  std::string_view name() const override { return name_; }
  bool on_host() const override { return false; }
  double* allocate(std::size_t count) const override {
    void* memory = nullptr;
    constexpr int out_of_memory = 2;
    const int result = driver_.allocate(&memory, count * sizeof(double));
    if (result == out_of_memory) throw std::bad_alloc();
    driver_.require(result, "memory was allocated");
    return static_cast<double*>(memory);
  }
  void release(double* numbers, std::size_t) const noexcept override { driver_.release(numbers); }
  void clear(double* numbers, std::size_t count) const override {
    driver_.require(driver_.clear(numbers, 0, count * sizeof(double)), "memory was cleared");
  }
  void copy(const double* from, std::size_t count, double* to) const override {
    copy(from, count, to, hip_driver::inside, "memory was copied");
  }
  void copy_from_host(const double* host, std::size_t count, double* to) const override {
    copy(host, count, to, hip_driver::to_device, "data were sent to it");
  }
  void copy_to_host(const double* from, std::size_t count, double* host) const override {
    copy(from, count, host, hip_driver::to_host, "results were read");
  }

 private:
  void copy(const double* from, std::size_t count, double* to, int kind, const char* doing) const {
    driver_.require(driver_.copy(to, from, count * sizeof(double), kind), doing);
  }
  const hip_driver& driver_;
  std::string name_;
};

std::string name_of(const hip_driver& driver, int number) {
  std::array<char, 128> name{};
  return driver.device_name(name.data(), static_cast<int>(name.size()) - 1, number) == 0 ? name.data()
                                                                                         : "unknown";
}

class hip_device final : public device {
 public:
  hip_device(const hip_driver& driver, int number)
      : driver_(driver), name_(name_of(driver, number)), memory_(driver, name_) {
    driver_.require(driver_.set_device(number), "it was opened");
    // The runtime accepts the code of its own processor alone.
    for (const auto& one : device_code_objects())
      if (std::string_view(one.processor).starts_with("gfx") && driver_.load(&code_, one.code) == 0) return;
    throw input_error(name_ + " cannot run the kernels (there is no code for it); use a gfx90a or gfx942");
  }

  std::string name() const override { return name_; }
  const memory_space& memory() const override { return memory_; }
  std::size_t bytes() const override { return info().second; }
  std::size_t free_bytes() const override { return info().first; }

  void start(std::string_view kernel, const launch_size& size, const void* arguments,
             std::size_t bytes_of_arguments) override {
    // The marks of the runtime for a buffer with all arguments, its size, and the end.
    void* extra[] = {reinterpret_cast<void*>(1), const_cast<void*>(arguments), reinterpret_cast<void*>(2),
                     &bytes_of_arguments, reinterpret_cast<void*>(3)};
    driver_.require(
        driver_.launch(function_of(std::string(kernel)), static_cast<unsigned>(size.blocks), 1, 1,
                       static_cast<unsigned>(size.lanes), 1, 1,
                       static_cast<unsigned>(size.shared_numbers * sizeof(double)), nullptr, nullptr, extra),
        "a kernel was started");
  }
  void finish() override { driver_.require(driver_.synchronize(), "kernels ran"); }

 private:
  hip_driver::handle function_of(const std::string& kernel) {
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

  const hip_driver& driver_;
  hip_driver::handle code_ = nullptr;
  std::string name_;
  hip_memory memory_;
  std::map<std::string, hip_driver::handle> functions_;
};

std::vector<std::string> hip_names() {
  const hip_driver* driver = hip_driver::find();
  int count = 0;
  if (driver == nullptr || driver->device_count(&count) != 0) return {};
  std::vector<std::string> all;
  for (int k = 0; k < count; ++k) all.push_back(name_of(*driver, k));
  return all;
}

}  // namespace

extern const device_backend_entry device_backend_hip;
const device_backend_entry device_backend_hip = {.name = "hip",
                                                 .description = "processors of AMD, by their runtime",
                                                 .is_real = true,
                                                 .names = hip_names,
                                                 .open = [](int number) -> std::unique_ptr<device> {
                                                   return std::make_unique<hip_device>(*hip_driver::find(),
                                                                                       number);
                                                 }};

}  // namespace apsis
