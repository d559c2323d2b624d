#pragma once

#include <apsis/output/field_series.hpp>

#include <string>

namespace apsis::xdmf {

/// Returns a structured grid for every snapshot of fields on a mesh with two or three axes, whose points are
/// geometry/centres of the file: every field as a scalar, and where their components are among the fields,
/// vectors NAME of NAME_x, NAME_y, NAME_z and symmetric tensors NAME of NAME_xx, NAME_xy, …, NAME_zz; in the
/// plane components with z that are not among the fields are 0. `epsilon`: whether the file has this dataset.
std::string grids_on_mesh(const field_series& fields, const std::string& file, bool epsilon);

}  // namespace apsis::xdmf
