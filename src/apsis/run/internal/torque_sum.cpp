#include <apsis/run/internal/torque_sum.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/run/body_loads.hpp>
#include <apsis/run/internal/surface_columns.hpp>

#include <array>
#include <utility>

namespace apsis {

torque_sum::torque_sum(const run_setup& setup) : setup_(setup), momenta_(places_of_momenta(*setup.equation)) {
  const auto bodies = loaded_bodies(setup);
  bodies_ = bodies.size();
  if (bodies.empty()) return;
  const domain& space = setup.builder().space();
  const std::size_t count = setup.equation->invariants().size();
  std::size_t first = 0, body = 0;
  for (std::size_t k = 0; k < space.budget_surfaces().size(); ++k) {
    const budget_surface& one = space.budget_surfaces()[k];
    if (body == bodies.size() || bodies[body].face != k) {
      first += space.ends_at(one) * count;
      continue;
    }
    const auto add = [&](const position& x, const std::array<double, 3>& normal,
                         const std::array<double, 3>& moment) {
      arms_.push_back({body, first, x, normal, moment});
      first += count;
    };
    for (const int surface : one.surfaces)
      for (int place = 0; place < space.surfaces()[at(surface)].own; ++place)
        add(space.meeting_point(surface, place), {}, {});
    for (const int wall : one.walls) {
      const wall_segment& piece = space.mesh().cut()->walls()[at(wall)];
      add(piece.middle, piece.normal, piece.moment);
    }
    ++body;
  }
}

std::vector<double> torque_sum::of(std::span<const double> amounts) const {
  if (bodies_ == 0) return {};
  const bool in_plane = setup_.whole_mesh().dimensions() == 2, about_axis = setup_.whole_mesh().has_axis();
  const std::size_t components = in_plane ? 1 : 3;
  std::vector<exact_sum> sums(bodies_ * components);
  for (const arm& one : arms_) {
    if (one.first >= amounts.size()) break;  // nothing was received
    if (about_axis) {
      sums[one.body].add(-one.x[1] * amounts[one.first + momenta_[2]]);  // −r p_θ
      continue;
    }
    double pressing = 0.0;  // p·n
    for (std::size_t k = 0; k < momenta_.size(); ++k)
      pressing += one.normal[k] * amounts[one.first + momenta_[k]];
    for (std::size_t c = 0; c < components; ++c) {
      // −(x × p) along the axis c; along z in the plane.
      const std::size_t a = in_plane ? 0 : (c + 1) % 3, b = in_plane ? 1 : (c + 2) % 3;
      exact_sum& sum = sums[one.body * components + c];
      sum.add(one.x[b] * amounts[one.first + momenta_[a]]);
      sum.add(-one.x[a] * amounts[one.first + momenta_[b]]);
      sum.add(-one.moment[in_plane ? 2 : c] * pressing);
    }
  }
  return global_values(setup_.processes(), sums);
}

}  // namespace apsis
