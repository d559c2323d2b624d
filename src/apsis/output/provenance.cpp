#include <apsis/output/provenance.hpp>

#include <apsis/core/version.hpp>
#include <apsis/exec/instruction_set.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/processes.hpp>
#include <apsis/output/hdf5_file.hpp>

#include <array>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include <boost/version.hpp>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace apsis {
namespace {

std::string compiler() {
#if defined(__clang__)
  return fmt::format("clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("gcc {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const auto colon = line.find(':');
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos && colon + 2 <= line.size())
      return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

nlohmann::ordered_json build_info() {
  return {
      {"compiler", compiler()},
      {"build_type", build_type()},
      {"instruction_set", kernel_instruction_set()},
      {"mpi", has_mpi()},
      {"libraries",
       {{"hdf5", hdf5_version()},
        {"boost", fmt::format("{}.{}", BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000)},
        {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)}}}};
}

nlohmann::ordered_json machine_info() {
  return {{"processor", processor()},
          {"cores", static_cast<int>(std::thread::hardware_concurrency())},
          {"threads", threads()}};
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "unknown";
}

std::vector<std::string> command_line() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string one; std::getline(in, one, '\0');) arguments.push_back(one);
  return arguments;
}

std::string time_stamp() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

}  // namespace apsis
