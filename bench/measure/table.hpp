#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace apsis::bench {

/// How much is measured: `repeats` turns of everything, or a run that only shows that everything works.
struct settings {
  int repeats = 5;
  bool quick = false;
};

/// A table of results; a cell is a number or a text.
struct table {
  std::string title;
  std::string note;  ///< what was measured, in which unit, and how the numbers are to be read
  std::vector<std::string> columns;
  std::vector<std::vector<nlohmann::json>> rows;
  nlohmann::json data = nlohmann::json::object();  ///< more than a table shows, for pictures
};

/// A measurement of `apsis_measure`. Adding one is adding a file to bench/measure/tables with
///   const registered here({"name", "what it answers", measure});
struct entry {
  std::string name, description;
  table (*measure)(const settings&);
};

class registered {
 public:
  explicit registered(entry what);
};

/// In the order of their names.
std::vector<entry> entries();

/// As Markdown, columns aligned.
std::string markdown(const table& what);
nlohmann::json to_json(const table& what);

/// Processor, caches, cores, compiler, flags, instruction set of the kernels, version and date.
nlohmann::json machine();

}  // namespace apsis::bench
