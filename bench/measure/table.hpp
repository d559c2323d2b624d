#pragma once

#include <apsis/exec/communicator.hpp>

#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace apsis::bench {

/// Settings of a measurement: `repeats` turns, or a quick smoke test.
struct settings {
  int repeats = 5;
  bool quick = false;
  std::string device;                                          ///< argument of open_device()
  std::shared_ptr<communicator> processes = single_process();  ///< processes that were started together
};

/// A table of results; a cell is a number or a string.
struct result_table {
  std::string title;
  std::string note;  ///< what was measured, units, and how to read the numbers
  std::vector<std::string> columns;
  std::vector<std::vector<nlohmann::json>> rows;
  nlohmann::json data = nlohmann::json::object();  ///< additional data for pictures
};

/// A measurement of `apsis_measure`. To add one, add a file to bench/measure/tables, or to its folder
/// with_sundials/ if the measurement calls SUNDIALS, with
///   const registered here({"name", "what it answers", measure});
/// The file has the name of the measurement, with _ for -.
struct entry {
  std::string name, description;
  result_table (*measure)(const settings&);
  bool on_several_processes = false;  ///< whether it requires several processes; these measure no other entry
  bool needs_device = false;          ///< whether it requires a device
};

class registered {
 public:
  explicit registered(entry what);
};

/// Returns all entries, sorted by name.
std::vector<entry> entries();

/// Returns the names of the measurements that this program lacks because it was built without SUNDIALS,
/// sorted.
std::vector<std::string> left_out();

/// Formats a table as Markdown.
std::string markdown(const result_table& what);
nlohmann::json to_json(const result_table& what);

/// Returns processor, caches, cores, compiler, flags, instruction set of the kernels, version and date.
nlohmann::json machine();

}  // namespace apsis::bench
