#pragma once

#include <apsis/body/triangle_surface.hpp>

#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// Returns the contents of the STL file that is built in under a name, "gas/satellite.stl" of
/// cases/gas/satellite.stl; nothing for another name.
std::optional<std::string> built_in_stl(const std::string& name);

/// Returns the triangles of an STL file, ASCII or binary, in units of the file. Coordinates are rounded to
/// single precision in both formats, so that equal corners stay equal; normals of the file are ignored. The
/// size distinguishes the formats, since binary files may also begin with "solid". A built-in
/// file is found by its name in every folder. Throws io_error if the file cannot be read. Throws input_error
/// with the line or byte for other contents: no triangle, a truncated file, an unexpected word, or a
/// coordinate that is not finite.
std::vector<space_triangle> read_stl(const std::string& path);

}  // namespace apsis
