#include <apsis/device/teams.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/device/internal/device_number.hpp>
#include <apsis/device/internal/kernel_table.hpp>
#include <apsis/exec/memory.hpp>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Memory of the host in the role of device memory. New numbers are NaN until they are written.
class team_memory final : public memory_space {
 public:
  std::string_view name() const override { return "lanes on the host"; }
  bool on_host() const override { return false; }
  double* allocate(std::size_t count) const override {
    double* numbers = host_memory().allocate(count);
    std::fill_n(numbers, count, std::numeric_limits<double>::quiet_NaN());
    return numbers;
  }
  void release(double* numbers, std::size_t count) const noexcept override {
    host_memory().release(numbers, count);
  }
  void clear(double* numbers, std::size_t count) const override { host_memory().clear(numbers, count); }
  void copy(const double* from, std::size_t count, double* to) const override {
    host_memory().copy(from, count, to);
  }
  void copy_from_host(const double* host, std::size_t count, double* to) const override {
    host_memory().copy(host, count, to);
  }
  void copy_to_host(const double* from, std::size_t count, double* host) const override {
    host_memory().copy(from, count, host);
  }
};

class team_device final : public device {
 public:
  explicit team_device(lane_order order) : order_(order) {}

  std::string name() const override { return "lanes on the host"; }
  const memory_space& memory() const override {
    static const team_memory only;
    return only;
  }
  std::size_t bytes() const override { return std::numeric_limits<std::size_t>::max(); }
  std::size_t free_bytes() const override { return bytes(); }
  void start(std::string_view kernel, const launch_size& size, const void* arguments,
             std::size_t bytes_of_arguments) override {
    const auto all = host_kernels();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.name == kernel; });
    if (found == all.end() || found->bytes_of_arguments != bytes_of_arguments)
      throw std::logic_error(
          fmt::format("no kernel '{}' with {} bytes of arguments", kernel, bytes_of_arguments));
    lane_team team(size.lanes, size.shared_numbers, order_);
    for (int block = 0; block < size.blocks; ++block)
      team.run(order_ == lane_order::backward ? size.blocks - 1 - block : block, size.blocks,
               [&](const team_lane& lane) { found->run(lane, arguments); });
  }
  void finish() override {}

 private:
  lane_order order_;
};

}  // namespace

std::unique_ptr<device> make_team_device(lane_order order) {
  return std::make_unique<team_device>(order);
}

extern const device_backend_entry device_backend_teams;
const device_backend_entry device_backend_teams = {
    .name = "teams",
    .description = "lanes on the host, one after the other, for tests",
    .is_real = false,
    .names = [] { return std::vector<std::string>{"lanes on the host"}; },
    .open =
        [](int number) {
          require_device_number(number, 1);
          return make_team_device(lane_order::forward);
        }};

}  // namespace apsis
