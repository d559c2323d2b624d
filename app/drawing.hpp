#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace apsis::app {

/// The embedded Python modules apsis.plot and apsis.report, which exist as files during the lifetime of
/// this object.
class drawing {
 public:
  /// Throws io_error if no Python with matplotlib, numpy and h5py is found, or if the files cannot be
  /// written. The environment variable APSIS_PYTHON names a Python.
  drawing();

  /// Writes one more file next to the modules and returns its path.
  std::string add(const std::string& name, const std::string& text) const;

  /// Runs `python -m apsis.MODULE ARGUMENTS` and returns its exit status; −1 if it cannot run. If `quiet`,
  /// its standard output is suppressed. Its messages go to the standard error of this program.
  int run(const std::string& module, const std::vector<std::string>& arguments, bool quiet) const;

 private:
  /// A new folder, removed with its contents at the end.
  class temporary_folder {
   public:
    temporary_folder();
    ~temporary_folder();
    temporary_folder(const temporary_folder&) = delete;
    temporary_folder& operator=(const temporary_folder&) = delete;
    const std::filesystem::path& path() const { return path_; }

   private:
    std::filesystem::path path_;
  };

  std::string python_;
  temporary_folder folder_;
};

/// Draws without output on standard output, for commands that print results there. Throws io_error if
/// that fails.
void draw(const std::string& module, const std::vector<std::string>& arguments);

}  // namespace apsis::app
