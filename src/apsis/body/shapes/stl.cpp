#include <apsis/body/read_stl.hpp>
#include <apsis/body/shape_registry.hpp>
#include <apsis/body/triangle_surface.hpp>
#include <apsis/core/errors.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {
namespace stl_shape {
namespace {

/// The signed distance from a closed surface of triangles.
class solid final : public shape {
 public:
  explicit solid(const std::vector<space_triangle>& triangles) : surface_(triangles) {}
  double outside(const position& x) const override { return surface_.signed_distance(x); }

 private:
  triangle_surface surface_;
};

std::shared_ptr<const shape> make(const shape_arguments& from) {
  const std::string& path = from.text("file");
  const double scale = from.number("scale");
  std::vector<space_triangle> triangles = read_stl(path);
  for (space_triangle& corners : triangles)
    for (position& corner : corners)
      for (double& x : corner) x *= scale;
  try {
    return std::make_shared<solid>(triangles);
  } catch (const input_error& problem) {
    throw input_error({path, 0, 0}, problem.what());
  }
}

}  // namespace
}  // namespace stl_shape

extern const shape_entry shape_stl;
const shape_entry shape_stl = {
    .name = "stl",
    .description = "closed surface of triangles from an STL file, ASCII or binary",
    .keys = {{.name = "file",
              .doc = "path of the STL file, or name of a built-in one: gas/satellite.stl",
              .kind = shape_value_kind::text},
             {.name = "scale",
              .doc = "factor of all coordinates of the file",
              .value = 1.0,
              .positive = true,
              .is_length = false}},
    .dimensions = {3},
    .alternative = "use 'polygon'",
    .make = stl_shape::make};

}  // namespace apsis
