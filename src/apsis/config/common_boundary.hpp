#pragma once

#include <apsis/config/case.hpp>
#include <apsis/config/case_text.hpp>

#include <string>

namespace apsis {

/// The name of the table [boundary.all], whose keys apply to every face without keys of its own.
inline constexpr const char* every_face = "all";

/// Replaces the variables of [boundary.all] by variables of the faces. A face with its own kind receives
/// none, and its own variables override those of [boundary.all]. Throws input_error at the place of a key if
/// space.boundary gives the kind too, or if no face uses the variable.
void expand_common_boundary(case_text& text);

/// Returns whether a variable of a face, "boundary.left.T", is that of [boundary.all].
bool is_common_boundary(const case_config& config, const std::string& path);

/// Returns the path of a variable of a face as the case gives it: "boundary.all.T" for "boundary.left.T" if
/// it is that of [boundary.all], otherwise `path`.
std::string given_boundary_path(const case_config& config, const std::string& path);

/// Erases the variables of a face that are those of [boundary.all].
void erase_common_boundary(case_text& text, const case_config& config, const std::string& face_name);

}  // namespace apsis
