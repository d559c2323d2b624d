#pragma once

#include <apsis/body/triangle_surface.hpp>

#include <string>
#include <vector>

namespace apsis {

/// Returns the triangles of an STL file, ASCII or binary, in units of the file. Coordinates are rounded to
/// single precision in both formats, so that equal corners stay equal; normals of the file are ignored. The
/// size distinguishes the formats, since binary files may also begin with "solid". Throws io_error if the
/// file cannot be read. Throws input_error with the line or byte for other contents: no triangle, a truncated
/// file, an unexpected word, or a coordinate that is not finite.
std::vector<space_triangle> read_stl(const std::string& path);

}  // namespace apsis
