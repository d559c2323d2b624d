// The devices of tests, and the main function of their programs. `make device-check` runs them on a real
// device (tests/device/check.sh). If APSIS_DEVICE is set and there is no device, the program prints "no
// device" and ends with exit code 77.
#include "tested_device.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/device/find_device.hpp>
#include <apsis/device/teams.hpp>

#include <cstdio>
#include <cstdlib>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace device_check {

using apsis::device;

namespace {

std::set<std::string>& names_of_kernels() {
  static std::set<std::string> names;
  return names;
}

std::size_t copied_to_host = 0;

/// The memory of a device. It counts the numbers that it copies to the host.
class counting_memory final : public apsis::memory_space {
 public:
  explicit counting_memory(const apsis::memory_space& real) : real_(real) {}

  std::string_view name() const override { return real_.name(); }
  bool on_host() const override { return real_.on_host(); }
  double* allocate(std::size_t count) const override { return real_.allocate(count); }
  void release(double* numbers, std::size_t count) const noexcept override { real_.release(numbers, count); }
  void clear(double* numbers, std::size_t count) const override { real_.clear(numbers, count); }
  void copy(const double* from, std::size_t count, double* to) const override { real_.copy(from, count, to); }
  void copy_from_host(const double* host, std::size_t count, double* to) const override {
    real_.copy_from_host(host, count, to);
  }
  void copy_to_host(const double* from, std::size_t count, double* host) const override {
    copied_to_host += count;
    real_.copy_to_host(from, count, host);
  }

 private:
  const apsis::memory_space& real_;
};

/// A device that records the names of its kernels.
class recording_device final : public device {
 public:
  explicit recording_device(std::shared_ptr<device> real)
      : real_(std::move(real)), memory_(real_->memory()) {}

  std::string name() const override { return real_->name(); }
  const apsis::memory_space& memory() const override { return memory_; }
  std::size_t bytes() const override { return real_->bytes(); }
  std::size_t free_bytes() const override { return real_->free_bytes(); }
  void start(std::string_view kernel, const apsis::launch_size& size, const void* arguments,
             std::size_t bytes_of_arguments) override {
    names_of_kernels().emplace(kernel);
    real_->start(kernel, size, arguments, bytes_of_arguments);
  }
  void finish() override { real_->finish(); }

 private:
  std::shared_ptr<device> real_;
  counting_memory memory_;
};

const char* wanted() {
  return std::getenv("APSIS_DEVICE");
}

std::shared_ptr<device> open_wanted() {
  const std::string name = wanted();
  return apsis::open_device(name == "first" ? "" : name);
}

std::vector<std::shared_ptr<device>> open_all() {
  std::vector<std::shared_ptr<device>> real;
  if (wanted() != nullptr) {
    real.push_back(open_wanted());
  } else {
    for (const auto order :
         {apsis::lane_order::forward, apsis::lane_order::backward, apsis::lane_order::random})
      real.push_back(apsis::make_team_device(order));
  }
  std::vector<std::shared_ptr<device>> all;
  for (auto& one : real) all.push_back(std::make_shared<recording_device>(std::move(one)));
  return all;
}

/// Opens the device. Returns 0, or the exit code of a program that cannot use the device.
int prepare() {
  constexpr int skipped = 77;
  const std::string name = wanted();
  if (name != "teams" && apsis::found_devices().empty()) {
    std::puts("no device");
    return skipped;
  }
  try {
    std::printf("device: %s\n", tested_device()->name().c_str());
    return 0;
  } catch (const apsis::error& failure) {
    std::printf("error: %s\n", failure.what());
    return 1;
  }
}

/// Runs the tests. A run without any test is an error, because it proves nothing.
int run_tests() {
  const int result = RUN_ALL_TESTS();
  if (testing::UnitTest::GetInstance()->test_to_run_count() > 0) return result;
  std::puts("no test was selected");
  return 1;
}

}  // namespace
}  // namespace device_check

const std::vector<std::shared_ptr<apsis::device>>& tested_devices() {
  static const auto all = device_check::open_all();
  return all;
}

std::size_t numbers_copied_to_host() {
  return device_check::copied_to_host;
}

const std::set<std::string>& kernels_that_ran() {
  return device_check::names_of_kernels();
}

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  if (device_check::wanted() == nullptr) return RUN_ALL_TESTS();
  if (const int code = device_check::prepare(); code != 0) return code;
  return device_check::run_tests();
}
