#pragma once

#include <apsis/velocity/velocity_config.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A kind of velocity line: a file of velocity/lines/ defines
/// `extern const velocity_line_entry velocity_line_<file>`.
struct velocity_line_entry {
  std::string name;         ///< name in a case file (velocity.set)
  std::string description;  ///< one line
  std::string source;       ///< citation
  bool needs_max = true;    ///< whether the largest velocity has no default
  /// Makes a line of `points` velocities up to about ±max; max = 0 stands for the default. Throws input_error
  /// for invalid numbers.
  velocity_line (*make)(int points, double max) = nullptr;
};

/// Returns every kind of line, sorted by file name (generated).
std::vector<const velocity_line_entry*> velocity_line_entries();

/// Returns the entry called `name`; nullptr for an unknown name.
const velocity_line_entry* try_find_velocity_line(const std::string& name);
/// Returns the entry called `name`. Throws input_error with the nearest name for an unknown one.
const velocity_line_entry& find_velocity_line(const std::string& name);

/// Whether a name of a set is that of a file, NAME.csv or NAME.txt.
bool is_velocity_file(const std::string& name);

/// Reads a line of velocities from a file with two columns, velocities and weights, separated by a comma or
/// spaces. Lines that begin with # are comments, and a first line of names is skipped. Throws io_error if the
/// file cannot be read, and input_error with the line number for other contents.
velocity_line read_velocity_line(const std::string& path);

/// Returns the lines of d = `dimensions` directions, 1 to 3. Throws input_error if numbers or names belong to
/// another number of directions, if a name is unknown, or if a line is invalid.
std::vector<velocity_line> make_lines(const velocity_config& of, int dimensions);

}  // namespace apsis
