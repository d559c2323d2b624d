#pragma once

#include <apsis/output/field_series.hpp>

#include <string>

namespace apsis::xdmf {

/// Returns a structured grid for every snapshot of fields on a mesh with several axes, whose points are
/// geometry/centres of the file: every field as a scalar, and where their components are among the fields,
/// vectors NAME of NAME_x, NAME_y (and NAME_z, else 0) and symmetric tensors NAME of NAME_xx, NAME_xy,
/// NAME_yy (and NAME_xz, NAME_yz, NAME_zz, else 0). `epsilon`: whether the file has this dataset.
std::string grids_on_mesh(const field_series& fields, const std::string& file, bool epsilon);

}  // namespace apsis::xdmf
