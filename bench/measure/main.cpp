// apsis_measure: measures the figures of docs/speed.md, prints the tables and adds them to a file.
#include "table.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/log.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/device/find_device.hpp>
#include <apsis/exec/memory.hpp>
#include <apsis/exec/processes.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using apsis::bench::entry;
using nlohmann::json;

json read_results(const std::string& path) {
  std::ifstream file(path);
  return file ? json::parse(file) : json::object();
}

/// Writes results to a temporary file first, so that an interrupt leaves the old file intact.
void write_results(const std::string& path, const json& results) {
  const std::filesystem::path target(path), beside(path + ".part");
  if (target.has_parent_path()) std::filesystem::create_directories(target.parent_path());
  std::ofstream(beside) << results.dump(1) << "\n";
  std::filesystem::rename(beside, target);
}

std::vector<entry> chosen(const std::vector<std::string>& names, bool several) {
  const auto all = apsis::bench::entries();
  std::vector<entry> some;
  if (names.empty()) {
    for (const auto& one : all)
      if (one.on_several_processes == several) some.push_back(one);
    return some;
  }
  const auto lacking = apsis::bench::left_out();
  std::vector<std::string> known = lacking;
  for (const auto& one : all) known.push_back(one.name);
  for (const auto& name : names) {
    if (std::find(lacking.begin(), lacking.end(), name) != lacking.end())
      throw apsis::input_error("'" + name +
                               "' is not part of this program (it was built without SUNDIALS); install "
                               "libsundials-dev and build it again");
    bool found = false;
    for (const auto& one : all)
      if (one.name == name) {
        if (one.on_several_processes != several)
          throw apsis::input_error(several
                                       ? "'" + name + "' is measured on one process; start it without mpirun"
                                       : "'" + name + "' compares processes; start several with mpirun -n 2");
        some.push_back(one);
        found = true;
      }
    if (!found)
      throw apsis::input_error("unknown measurement '" + name + "'; " + apsis::suggest(name, known));
  }
  return some;
}

int measure(const std::vector<std::string>& names, const std::string& path,
            const apsis::bench::settings& options) {
  const bool writes = options.processes->is_root();
  for (const auto& one : chosen(names, !options.processes->is_single())) {
    if (one.needs_device && options.device.empty() && apsis::found_devices().empty()) {
      fmt::print("no device\n");
      constexpr int skipped = 77;
      if (!names.empty()) return skipped;
      continue;
    }
    if (writes) fmt::print(stderr, "measuring {}: {}\n", one.name, one.description);
    const auto table = one.measure(options);
    if (!writes) continue;
    json result = to_json(table);
    result["machine"] = apsis::bench::machine();
    result["repeats"] = options.repeats;
    fmt::print("{}\n", markdown(table));
    std::fflush(stdout);
    if (path.empty()) continue;
    json results = read_results(path);
    results[one.name] = result;
    write_results(path, results);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"Measures the speed of Apsis as ratios and as fractions of ceilings of the same run."};
  std::vector<std::string> names;
  std::string path;
  apsis::bench::settings options;
  bool list = false;
  program.add_option("NAME", names, "measurements; default: all");
  program.add_option("--out", path, "JSON file to which results are added");
  program.add_option("--repeats", options.repeats, "number of turns; results are medians")
      ->check(CLI::Range(1, 1000));
  program.add_option("--device", options.device,
                     "device of the measurement 'device'; default: the first one; teams: lanes on the host");
  program.add_flag("--quick", options.quick, "smoke test on small problems, without meaningful results");
  program.add_flag("--list", list, "list the measurements");
  CLI11_PARSE(program, argc, argv);
  apsis::keep_freed_memory();  // as the program does
  try {
    options.processes = apsis::launched_processes();
    if (!options.processes->is_root()) apsis::log::set_level(apsis::log::level::quiet);
    if (list) {
      for (const auto& one : apsis::bench::entries()) fmt::print("{:<14} {}\n", one.name, one.description);
      for (const auto& name : apsis::bench::left_out())
        fmt::print("{:<14} (not part of this program: built without SUNDIALS)\n", name);
      return 0;
    }
    return measure(names, path, options);
  } catch (const apsis::input_error& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 1;
  }
}
