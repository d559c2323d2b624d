#pragma once

#include <functional>
#include <source_location>
#include <string>
#include <vector>

/// Tables of bad input: the input, the place that the message names, its key words, and the exit code.
namespace bad_input {

/// One row, read from a table.
struct row {
  std::string label;              ///< file and line of the row
  std::string text;               ///< the case with its change; "" in a row with arguments
  std::vector<std::string> set;   ///< overrides
  std::vector<std::string> run;   ///< arguments of the program
  std::string place;              ///< beginning of the message; "" in a row with arguments that names none
  std::vector<std::string> says;  ///< parts of the message
  int code = 2;                   ///< exit code; 0 if the input is accepted
};

/// Exit code and message of an input.
struct answer {
  int code = 0;
  std::string message;
};

/// Returns the code and the message of the error that `input` throws, or the code 0.
answer answer_of(const std::function<void()>& input);

/// Returns the rows of a file, or of all *.toml of a folder. A file is an array [[table]]. A table has a
/// valid case as `text`, or the name of a built-in one as `case`, and `rows`, inline tables, one a line. The
/// case itself becomes a row that must be accepted. Keys of a row:
/// - the change: `from` is replaced by `to`, `append` is added at the end, `set` are overrides (a text or a
/// list), `text` is the whole input, or `run` are the arguments of the program;
/// - `at`, the place: "line:column", "line:" where the TOML parser chooses the column, an override, or ""
/// where the message names none. Without `at` the message names the only override of the row;
/// - `says` (a text or a list), and `code` unless it is 2.
/// `text_of_case` returns the text of a built-in case.
std::vector<row> rows_in(const std::string& path,
                         const std::function<std::string(const std::string&)>& text_of_case = {});

/// Checks code, place and key words of every row, and records its message. tests/docs/test_bad_input.py
/// checks the grammar of all messages.
void expect_answers(const std::vector<row>& rows, const std::function<answer(const row&)>& ask);

/// A call that must be refused. Only C++ can express its input.
struct call {
  std::function<void()> input;
  std::vector<std::string> says;  ///< parts of the message
  int code = 2;                   ///< exit code
};

/// Checks code and key words of every row, and records its message as `expect_answers` does.
void expect_refused(const std::vector<call>& calls,
                    const std::source_location& place = std::source_location::current());

}  // namespace bad_input
