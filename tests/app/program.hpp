#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace app_test {

struct outcome {
  int code = -1;  ///< exit code; 1000 + signal if a signal ended the program
  std::string out, err;
};

/// A temporary folder for one test, removed at its end.
class work_folder {
 public:
  work_folder();
  ~work_folder();
  work_folder(const work_folder&) = delete;
  work_folder& operator=(const work_folder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string file(const std::string& name, const std::string& text) const;
  /// Returns every path below the folder, sorted, with sizes. Two equal listings mean that no file
  /// was left behind.
  std::vector<std::string> listing() const;

 private:
  std::filesystem::path path_;
};

/// The program, started in `folder`, with its output in adjacent files.
class process {
 public:
  enum class hangups { received, ignored };
  /// Starts the program; with `ignored` it ignores hangups, as under nohup.
  process(const work_folder& folder, const std::vector<std::string>& arguments,
          hangups hangup = hangups::received);
  void send(int signal) const;
  /// Waits without a time limit until seen() or the end of the program, and returns seen().
  bool wait_until(const std::function<bool()>& seen) const;
  /// Returns the text on standard error so far.
  std::string said() const;
  /// Waits until standard error has the text; returns false if the program ends without it.
  bool wait_for(const std::string& text) const;
  outcome wait();

 private:
  std::filesystem::path capture_;
  pid_t id_;
};

outcome run_apsis(const work_folder& folder, const std::vector<std::string>& arguments);

std::string read(const std::filesystem::path& path);

/// Appends `more` to the arguments.
inline std::vector<std::string> with(std::vector<std::string> arguments,
                                     const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace app_test
