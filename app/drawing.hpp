#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace apsis::app {

/// The Python modules apsis.plot and apsis.report, which are embedded in the program, as files during the
/// lifetime of this object.
class drawing {
 public:
  /// Throws io_error if no Python with matplotlib is found (the variable APSIS_PYTHON names one), or the
  /// files cannot be written.
  drawing();
  ~drawing();
  drawing(const drawing&) = delete;
  drawing& operator=(const drawing&) = delete;

  /// Writes one more file next to the modules and returns its path.
  std::string add(const std::string& name, const std::string& text) const;

  /// Exit status of `python -m apsis.MODULE ARGUMENTS`; −1 if it cannot run. If `quiet`, its standard output
  /// is suppressed; messages go to our standard error.
  int run(const std::string& module, const std::vector<std::string>& arguments, bool quiet) const;

 private:
  std::string python_;
  std::filesystem::path folder_;
};

/// Draws during a computation without output on standard output. Throws io_error if that fails.
void draw(const std::string& module, const std::vector<std::string>& arguments);

}  // namespace apsis::app
