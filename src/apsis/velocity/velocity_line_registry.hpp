#pragma once

#include <apsis/velocity/velocity_config.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A kind of velocity line: a file of model/lines/ defines `extern const velocity_line_entry
/// velocity_line_<file>`.
struct velocity_line_entry {
  std::string name;         ///< name in a case file (velocity.set)
  std::string description;  ///< one line
  std::string source;       ///< citation
  bool needs_max = true;    ///< whether there is no largest velocity by default
  /// Makes a line of `points` velocities up to about ±max; max = 0 is the default. Throws input_error for
  /// numbers that are not possible.
  velocity_line (*make)(int points, double max) = nullptr;
};

/// Every kind of line, sorted by file name (generated).
std::vector<const velocity_line_entry*> velocity_line_entries();

/// Returns the entry of a name; nullptr for an unknown name.
const velocity_line_entry* try_find_velocity_line(const std::string& name);
/// Returns the entry of a name. Throws input_error with the nearest name for an unknown one.
const velocity_line_entry& find_velocity_line(const std::string& name);

/// Whether the name of a set is that of a file.
bool is_velocity_file(const std::string& name);

/// Reads a line from a file of two columns, velocities and weights, separated by a comma or spaces; lines
/// that begin with # are comments, and a first line of names is skipped. Throws io_error if it cannot be
/// read, and input_error with its line for other contents.
velocity_line read_velocity_line(const std::string& path);

/// Returns the lines of d directions. Throws input_error whose message begins with the key: numbers or names
/// for another number of directions, an unknown name, or a line that cannot be made.
std::vector<velocity_line> make_lines(const velocity_config& of, int dimensions);

}  // namespace apsis
