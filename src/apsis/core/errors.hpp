#pragma once

#include <limits>
#include <stdexcept>
#include <string>

namespace apsis {

/// Exit codes of the program, one for each exception type.
enum class exit_code : int {
  success = 0,
  internal = 1,      ///< an error of Apsis itself
  input = 2,         ///< input_error
  numerical = 3,     ///< numerical_error
  output = 4,        ///< io_error
  claim = 5,         ///< claim_error
  interrupted = 130  ///< interrupted by a signal
};

/// Position of an input error in a text.
struct source_place {
  std::string file;  ///< path, or another name of the text in messages; "" means unknown
  int line = 0;      ///< counts from 1; 0 means unknown
  int column = 0;    ///< counts from 1; 0 means unknown; ignored without a line
};

/// Formats a position as "file:line:column: ", leaving out unknown parts; "" if everything is unknown.
std::string to_string(const source_place& place);

/// Base class of all errors that Apsis throws deliberately. Messages read "problem (reason); suggestion."
class error : public std::runtime_error {
 public:
  /// what() is `message`.
  error(exit_code code, const std::string& message) : std::runtime_error(message), code_(code) {}
  exit_code code() const { return code_; }  ///< exit code of the program

 private:
  exit_code code_;
};

/// An invalid case file, method file, key or argument.
class input_error : public error {
 public:
  /// Error in input that has no position in a text.
  explicit input_error(const std::string& message) : error(exit_code::input, message) {}
  /// what() is to_string(place) followed by `message`.
  input_error(const source_place& place, const std::string& message)
      : error(exit_code::input, to_string(place) + message) {}
};

/// Where a numerical failure occurred; negative numbers and NaN mean "unknown".
struct failure_site {
  long step = -1;                                           ///< number of the step
  double t = std::numeric_limits<double>::quiet_NaN();      ///< time reached (dimensionless)
  long cell = -1;                                           ///< from 0, in grid order
  double value = std::numeric_limits<double>::quiet_NaN();  ///< the offending value
};

/// A computation that cannot continue, or that violates a promise made at its start.
class numerical_error : public error {
 public:
  /// what() is `problem` followed by the known parts of the site in brackets.
  explicit numerical_error(const std::string& problem, failure_site site = {});
  const failure_site& site() const { return site_; }       ///< where it occurred, as far as known
  const std::string& problem() const { return problem_; }  ///< the message without the site
  /// Returns the same failure with step and time, which only the time loop can add.
  numerical_error at(long step, double t) const;

 private:
  std::string problem_;
  failure_site site_;
};

/// A file or folder that cannot be read or written.
class io_error : public error {
 public:
  /// `message` names the path.
  explicit io_error(const std::string& message) : error(exit_code::output, message) {}
};

/// A method or a result that lacks a claimed property.
class claim_error : public error {
 public:
  /// `message` states the claimed and the computed value.
  explicit claim_error(const std::string& message) : error(exit_code::claim, message) {}
};

}  // namespace apsis
