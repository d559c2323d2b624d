#pragma once

#include <limits>
#include <stdexcept>
#include <string>

namespace apsis {

/// Exit codes of the program; one exception type for each kind of failure.
enum class exit_code : int {
  success = 0,
  internal = 1,
  input = 2,
  numerical = 3,
  output = 4,
  claim = 5,
  interrupted = 130
};

/// Where in a text an input error stands; line and column count from 1, 0 means unknown.
struct source_place {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:column: " as far as it is known, "" if nothing is.
std::string to_string(const source_place& place);

/// Base of all errors that Apsis throws on purpose. Message grammar: problem (why) suggestion.
class error : public std::runtime_error {
 public:
  error(exit_code code, const std::string& message) : std::runtime_error(message), code_(code) {}
  exit_code code() const { return code_; }

 private:
  exit_code code_;
};

/// A case file, method file, key or argument that cannot be used.
class input_error : public error {
 public:
  explicit input_error(const std::string& message) : error(exit_code::input, message) {}
  input_error(const source_place& place, const std::string& message)
      : error(exit_code::input, to_string(place) + message) {}
};

/// Where a numerical failure happened; negative numbers mean "not known".
struct failure_site {
  long step = -1;
  double t = std::numeric_limits<double>::quiet_NaN();
  long cell = -1;
  double value = std::numeric_limits<double>::quiet_NaN();
};

/// The computation cannot go on, or a promise made at the start was broken.
class numerical_error : public error {
 public:
  explicit numerical_error(const std::string& problem, failure_site site = {});
  const failure_site& site() const { return site_; }
  const std::string& problem() const { return problem_; }
  /// The same failure with step and time filled in (they are known only to the time loop).
  numerical_error at(long step, double t) const;

 private:
  std::string problem_;
  failure_site site_;
};

/// A file or folder that cannot be read or written.
class io_error : public error {
 public:
  explicit io_error(const std::string& message) : error(exit_code::output, message) {}
};

/// A method (or a result) does not have the properties that are claimed for it.
class claim_error : public error {
 public:
  explicit claim_error(const std::string& message) : error(exit_code::claim, message) {}
};

}  // namespace apsis
