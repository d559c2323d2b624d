#pragma once

#include <limits>
#include <stdexcept>
#include <string>

namespace apsis {

/// Exit codes of the program; one exception type for each kind of failure.
enum class exit_code : int {
  success = 0,
  internal = 1,      ///< an error of Apsis itself
  input = 2,         ///< input_error
  numerical = 3,     ///< numerical_error
  output = 4,        ///< io_error
  claim = 5,         ///< claim_error
  interrupted = 130  ///< by a signal
};

/// Where in a text an input error stands; line and column count from 1, 0 means unknown.
struct source_place {
  std::string file;  ///< path, or what else a message calls the text; "" means unknown
  int line = 0;      ///< from 1
  int column = 0;    ///< from 1; of no meaning without a line
};

/// "file:line:column: " as far as it is known, "" if nothing is.
std::string to_string(const source_place& place);

/// Base of all errors that Apsis throws on purpose. Message grammar: problem (reason); suggestion.
class error : public std::runtime_error {
 public:
  /// `message` is what().
  error(exit_code code, const std::string& message) : std::runtime_error(message), code_(code) {}
  exit_code code() const { return code_; }  ///< with which the program ends

 private:
  exit_code code_;
};

/// A case file, method file, key or argument that cannot be used.
class input_error : public error {
 public:
  /// Of input that has no place in a text.
  explicit input_error(const std::string& message) : error(exit_code::input, message) {}
  /// what() is `message` behind to_string(place).
  input_error(const source_place& place, const std::string& message)
      : error(exit_code::input, to_string(place) + message) {}
};

/// Where a numerical failure happened; negative numbers and NaN mean "not known".
struct failure_site {
  long step = -1;                                           ///< number of the step
  double t = std::numeric_limits<double>::quiet_NaN();      ///< time that was reached (dimensionless)
  long cell = -1;                                           ///< from 0, in grid order
  double value = std::numeric_limits<double>::quiet_NaN();  ///< the number that should not be
};

/// The computation cannot go on, or a promise made at the start was broken.
class numerical_error : public error {
 public:
  /// what() is `problem`, followed in brackets by what is known of the site.
  explicit numerical_error(const std::string& problem, failure_site site = {});
  const failure_site& site() const { return site_; }       ///< as far as it is known
  const std::string& problem() const { return problem_; }  ///< the message without the site
  /// The same failure with step and time filled in (they are known only to the time loop).
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

/// A method (or a result) does not have the properties that are claimed for it.
class claim_error : public error {
 public:
  /// `message` says what was claimed and what was found.
  explicit claim_error(const std::string& message) : error(exit_code::claim, message) {}
};

}  // namespace apsis
