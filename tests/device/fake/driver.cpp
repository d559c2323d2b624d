// A library with the functions of the CUDA driver that Apsis calls. Its device is memory of the host. Its
// kernels are those of the host, run by teams of lanes. The variable FAKE_DEVICE selects a failure or a
// number of devices:
// - "old": a device of compute capability 6.1
// - "old-driver": a driver that refuses the code
// - "small": a device with 1 MB
// - "lost": a device that fails after ten launches
// - "wrong": a device with a wrong last bit in the first number of every result
// - "three": three devices
#include <apsis/device/internal/kernel_table.hpp>
#include <apsis/device/lane_team.hpp>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

namespace {

constexpr std::size_t one_megabyte = std::size_t{1} << 20;
std::size_t used = 0;
int launches = 0;

bool behaves(std::string_view as) {
  const char* value = std::getenv("FAKE_DEVICE");
  return value != nullptr && as == value;
}

std::size_t size() {
  return behaves("small") ? one_megabyte : 1024 * one_megabyte;
}

int devices() {
  return behaves("three") ? 3 : 1;
}

template <class T>
T* at(std::uint64_t address) {
  return reinterpret_cast<T*>(address);
}

}  // namespace

extern "C" {

int cuInit(unsigned) {
  return 0;
}
int cuDeviceGetCount(int* count) {
  *count = devices();
  return 0;
}
int cuDeviceGet(int* device, int number) {
  *device = number;
  return number < devices() ? 0 : 101;
}
int cuDeviceGetName(char* name, int length, int device) {
  const std::string text = "fake processor" + (device > 0 ? " " + std::to_string(device) : std::string());
  std::strncpy(name, text.c_str(), static_cast<std::size_t>(length));
  return 0;
}
int cuDeviceGetAttribute(int* value, int attribute, int) {
  constexpr int major = 75;
  *value = attribute == major ? (behaves("old") ? 6 : 9) : (behaves("old") ? 1 : 0);
  return 0;
}
int cuDevicePrimaryCtxRetain(void** context, int) {
  *context = &used;
  return 0;
}
int cuCtxSetCurrent(void*) {
  return 0;
}
int cuDevicePrimaryCtxRelease_v2(int) {
  launches = 0;
  return 0;
}
int cuMemGetInfo_v2(std::size_t* free, std::size_t* total) {
  *total = size();
  *free = size() - used;
  return 0;
}
int cuModuleLoadDataEx(void** code, const void* image, unsigned, int*, void**) {
  *code = const_cast<void*>(image);
  // PTX is text that begins with a comment.
  return behaves("old-driver") ? 222 : std::strncmp(static_cast<const char*>(image), "//", 2) == 0 ? 0 : 200;
}
int cuModuleGetFunction(void** function, void*, const char* name) {
  for (const auto& kernel : apsis::host_kernels())
    if (std::string_view(kernel.name) == name) {
      *function = const_cast<apsis::host_kernel*>(&kernel);
      return 0;
    }
  return 500;
}
int cuFuncSetAttribute(void*, int, int) {
  return 0;
}
int cuMemAlloc_v2(std::uint64_t* memory, std::size_t bytes) {
  if (used + bytes > size()) return 2;
  // The size is stored before the numbers.
  constexpr std::size_t head = 64;
  void* made = std::aligned_alloc(head, (bytes + 2 * head - 1) / head * head);
  std::memset(made, 0xff, bytes + head);
  std::memcpy(made, &bytes, sizeof bytes);
  used += bytes;
  *memory = reinterpret_cast<std::uint64_t>(made) + head;
  return 0;
}
int cuMemFree_v2(std::uint64_t memory) {
  constexpr std::size_t head = 64;
  std::size_t bytes = 0;
  std::memcpy(&bytes, at<void>(memory - head), sizeof bytes);
  used -= bytes;
  std::free(at<void>(memory - head));
  return 0;
}
int cuMemsetD8_v2(std::uint64_t memory, unsigned char value, std::size_t bytes) {
  std::memset(at<void>(memory), value, bytes);
  return 0;
}
int cuMemcpyDtoD_v2(std::uint64_t to, std::uint64_t from, std::size_t bytes) {
  std::memcpy(at<void>(to), at<void>(from), bytes);
  return 0;
}
int cuMemcpyHtoD_v2(std::uint64_t to, const void* from, std::size_t bytes) {
  std::memcpy(at<void>(to), from, bytes);
  return 0;
}
int cuMemcpyDtoH_v2(void* to, std::uint64_t from, std::size_t bytes) {
  std::memcpy(to, at<void>(from), bytes);
  if (behaves("wrong") && bytes > 0) *static_cast<unsigned char*>(to) ^= 1;
  return 0;
}
int cuLaunchKernel(void* function, unsigned blocks, unsigned, unsigned, unsigned lanes, unsigned, unsigned,
                   unsigned shared_bytes, void*, void** arguments, void**) {
  if (behaves("lost") && ++launches > 10) return 719;
  const auto& kernel = *static_cast<const apsis::host_kernel*>(function);
  apsis::lane_team team(static_cast<int>(lanes), shared_bytes / sizeof(double), apsis::lane_order::random);
  for (unsigned block = 0; block < blocks; ++block)
    team.run(static_cast<int>(block), static_cast<int>(blocks),
             [&](const apsis::team_lane& lane) { kernel.run(lane, arguments[0]); });
  return 0;
}
int cuCtxSynchronize() {
  return 0;
}
int cuGetErrorString(int error, const char** text) {
  *text = error == 719 ? "unspecified launch failure" : "an error";
  return 0;
}
}
