#pragma once

#include "progress_bar.hpp"

#include <apsis/output/picture.hpp>
#include <apsis/output/result_folder.hpp>
#include <apsis/study/study_control.hpp>

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

namespace apsis::app {

/// The options of a command that runs a case many times.
struct study_options {
  std::string case_name;
  std::vector<std::string> overrides;
  std::optional<std::string> out;
  std::optional<int> threads;
  bool json = false;
};

/// Adds CASE, key=value, --out, --json and --threads. `name`: name of the files; `row`: the subject of a row
/// of the table, such as "run"; `of_threads`: the help of --threads.
void add_study_options(CLI::App& command, study_options& given, const std::string& name,
                       const std::string& row, const std::string& of_threads);

/// The results of a study.
struct study_results {
  std::string name;             ///< name of its files: "converge"
  std::string csv;              ///< the table
  nlohmann::ordered_json rows,  ///< the table as an array of objects
      subject;                  ///< the entries of the manifest that describe what was run
  picture drawn;
  bool complete = true;  ///< false after an interruption
  long failures = 0;     ///< rows without a result
};

/// Writes NAME.csv, NAME.json, picture.json, manifest.json and NAME.png. Without Python it warns instead of
/// writing the picture. Throws io_error.
void write_study(result_folder& folder, const study_results& results);

/// Prints the rows as JSON, or `text`.
void print_study(const study_options& given, const nlohmann::ordered_json& rows, const std::string& text);

/// Returns callbacks that draw into `bar`, which must outlive them, and stop at an interrupt.
study_control shown_in(progress_bar& bar);

}  // namespace apsis::app
