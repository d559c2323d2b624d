#pragma once

#include <apsis/output/field_series.hpp>

#include <string>

namespace apsis::xdmf {

/// Returns a structured grid for every snapshot of fields on a mesh with two or three axes. Its points are
/// geometry/centres of the file. Every field is a scalar. Fields NAME_x, NAME_y, NAME_z also form a vector
/// NAME, fields NAME_xx, NAME_xy, …, NAME_zz a symmetric tensor NAME. In the plane, missing components with z
/// are 0. `epsilon`: whether the file has this dataset.
std::string grids_on_mesh(const field_series& fields, const std::string& file, bool epsilon);

}  // namespace apsis::xdmf
