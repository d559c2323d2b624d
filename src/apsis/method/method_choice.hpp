#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// The value of time.method for which the program chooses the method.
inline constexpr std::string_view automatic_method = "auto";

/// The properties of a problem on which the choice of a method depends.
struct method_request {
  bool space = false;                        ///< the problem is discretized in space
  bool general = false;                      ///< Q is any function, and Newton's method solves the stages
  bool signs = false;                        ///< bounds of the solution, such as f ≥ 0, must be preserved
  bool graded_start = false;                 ///< the first steps resolve the initial layer
  bool longest_steps = false;                ///< steps are a fraction of the longest that the method allows
  std::optional<double> tolerance = {};      ///< of a step; without it steps are equal
  std::optional<double> lowest_ratio = {};   ///< smallest CΔt/ε over the domain; nothing if unknown
  std::optional<double> highest_ratio = {};  ///< the largest
};

/// A row of the table of choices. The first row that applies decides.
struct choice_row {
  std::string problem;                   ///< "space", "system", "general" (a system with any Q), or "any"
  std::optional<bool> signs;             ///< whether bounds must be preserved; nothing: either
  bool explicit_method = false;          ///< the method resolves ε/C: only where CΔt/ε ≤ resolved_ratio
  std::optional<double> tolerance_from;  ///< smallest tolerance of the row; nothing: equal steps
  bool longest_steps = false;            ///< only where the method determines the length of steps
  std::string method;                    ///< name of the method
  std::string why;                       ///< the property that won, for the log
  std::string origin;                    ///< the measurement that decides
};

/// Largest CΔt/ε at which an explicit method may be chosen. Its steps are then stable, also if the rate C
/// grows moderately.
inline constexpr double resolved_ratio = 0.5;

/// Returns the table: methods that win the benchmarks of docs/speed.md. A test compares it with
/// docs/data/speed.
const std::vector<choice_row>& choice_table();

/// A method and why it was chosen.
struct method_choice {
  std::string method,  ///< its name
      reason;          ///< "equal steps on a mesh, C dt/epsilon = 0.02 to 30: …"
};

/// Chooses by the table. The result depends on the request alone.
method_choice choose_method(const method_request& wanted);

}  // namespace apsis
