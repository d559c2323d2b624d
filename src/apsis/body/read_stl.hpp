#pragma once

#include <apsis/body/triangle_surface.hpp>

#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// Returns the contents of a built-in STL file; nothing for an unknown name. The name of
/// cases/gas/satellite.stl is "gas/satellite.stl".
std::optional<std::string> built_in_stl(const std::string& name);

/// Returns the triangles of an STL file, ASCII or binary, in units of the file. Coordinates are rounded to
/// single precision in both formats, so that equal corners stay equal; normals of the file are ignored. The
/// size of the file distinguishes the formats, because binary files may also begin with "solid". A built-in
/// file is found by its name in every folder. Throws io_error if the file cannot be read. Throws input_error
/// with the line or byte for other contents: no triangle, a truncated file, an unexpected word, or a
/// coordinate that is not finite.
std::vector<space_triangle> read_stl(const std::string& path);

}  // namespace apsis
