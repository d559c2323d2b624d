// Tests the backend of the driver with the library of driver.cpp in its place. Runs have the bits of the
// host, and each failure has one message.
#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/device/find_device.hpp>
#include <apsis/run/session.hpp>

#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/folder.hpp>

namespace with_driver_test {

using namespace apsis;
using testing::HasSubstr;

namespace {

/// Makes the driver fail in one way during its lifetime.
class failing {
 public:
  explicit failing(const char* way) { setenv("FAKE_DEVICE", way, 1); }
  ~failing() { unsetenv("FAKE_DEVICE"); }
  failing(const failing&) = delete;
  failing& operator=(const failing&) = delete;
};

case_config small_gas(int cells = 20) {
  return parse_case(
      "[model]\nname = \"bgk\"\nepsilon = \"0.001 + 0.1*x\"\n[space]\ncells = " + std::to_string(cells) +
          "\ndomain = [0.0, 2.0]\nformulation = \"finite-difference\"\n[velocity]\nmax = 9.0\npoints = 36\n"
          "[time]\nmethod = \"md-imex-6-3\"\nsafety = 1\nend = 0.1\n[boundary.left]\nkind = \"diffuse\"\nT = "
          "1.1\n"
          "[boundary.right]\nkind = \"outflow\"\n",
      "gas.toml");
}

std::vector<double> end_of_run(bool on_device, const std::optional<std::string>& folder = {}) {
  session_options how;
  if (on_device) how.on = open_device("");
  how.out = folder;
  run_session session(small_gas(), how);
  session.run();
  return session.computed().state();
}

}  // namespace

TEST(with_driver, a_device_is_found_and_opened_by_its_number_and_place) {
  const auto all = found_devices();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].place, "cuda:0");
  EXPECT_EQ(all[0].name, "fake processor");
  for (const char* name : {"", "0", "cuda:0"}) EXPECT_EQ(open_device(name)->name(), "fake processor") << name;
  EXPECT_THAT([] { open_device("1"); },
              testing::ThrowsMessage<input_error>(
                  HasSubstr("no device '1' (this machine has cuda:0 (fake processor)); give one of these")));
}

TEST(with_driver, a_number_without_a_device_is_refused) {
  const failing now("three");
  for (const device_backend_entry* kind : device_backend_entries()) {
    if (kind->name != "cuda") continue;
    for (const int number : {-1, 3})
      EXPECT_THAT([&] { kind->open(number); },
                  testing::ThrowsMessage<input_error>(
                      HasSubstr(fmt::format("no device {} (devices have the numbers 0 to 2)", number))));
  }
}

TEST(with_driver, processes_of_a_machine_take_its_devices_in_turn) {
  const failing now("three");
  const auto name = [](const std::string& wanted, int process) {
    return open_device(wanted, process)->name();
  };
  EXPECT_EQ(name("0", 0), "fake processor");
  EXPECT_EQ(name("0", 2), "fake processor 2");
  EXPECT_EQ(name("1", 1), "fake processor 2");
  EXPECT_EQ(name("1", 2), "fake processor");
  EXPECT_EQ(name("0", 7), "fake processor 1");
  for (const int process : {0, 1, 2}) EXPECT_EQ(name("cuda:1", process), "fake processor 1");
}

TEST(with_driver, a_run_has_the_bits_of_the_host) {
  EXPECT_EQ(end_of_run(true), end_of_run(false));
}

TEST(with_driver, old_processors_and_old_drivers_are_refused) {
  {
    const failing now("old");
    EXPECT_THAT([] { open_device(""); },
                testing::ThrowsMessage<input_error>(HasSubstr("its compute capability is 6.1")));
  }
  const failing now("old-driver");
  EXPECT_THAT([] { open_device(""); },
              testing::ThrowsMessage<input_error>(HasSubstr("is too old for the kernels")));
}

TEST(with_driver, a_case_that_the_device_cannot_hold_is_refused_before_the_run) {
  const failing now("small");
  session_options how;
  how.on = open_device("");
  EXPECT_THAT([&] { run_session(small_gas(2000), how); },
              testing::ThrowsMessage<io_error>(testing::ContainsRegex(
                  "the device fake processor has .* of free memory \\(the run needs about")));
}

/// The results so far are kept, as after other failures.
TEST(with_driver, a_device_that_is_lost_ends_the_run_with_a_message) {
  const failing now("lost");
  const test_folder folder;
  EXPECT_THAT(
      [&] { end_of_run(true, folder / "run"); },
      testing::ThrowsMessage<io_error>(HasSubstr(
          "the device failed while a kernel was started (CUDA error 719: unspecified launch failure); "
          "restart from the last checkpoint")));
}

}  // namespace with_driver_test
