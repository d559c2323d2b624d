#pragma once

#include <apsis/method/method.hpp>
#include <apsis/output/result_folder.hpp>

#include <filesystem>
#include <string>

namespace apsis::app {

/// The method file of a command, which always contains the best method so far.
class method_writer {
 public:
  /// Throws input_error unless the path ends in .toml, its stem can be the name of a new method, and its
  /// folder exists.
  explicit method_writer(const std::string& path);

  std::string name() const { return path_.stem().string(); }
  std::string path() const { return path_.string(); }

  /// Replaces the file. Throws io_error; the previous file is then unchanged.
  void write(const method& m);

 private:
  std::filesystem::path path_;
  result_folder folder_;
};

}  // namespace apsis::app
