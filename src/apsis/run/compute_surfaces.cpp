#include <apsis/run/compute_surfaces.hpp>

#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/run/internal/surface_columns.hpp>
#include <apsis/run/wall_outlines.hpp>
#include <apsis/semidiscrete/face_fluxes.hpp>
#include <apsis/velocity/component_name.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>

namespace apsis {
namespace {

/// Returns the face of the domain on which a surface lies, or the face of a box. A box has its upper face
/// where segments begin.
face face_beside(const surface& one) {
  return {one.where.direction, one.solid < 0 ? one.where.upper : !one.where.upper};
}

/// Returns the arc length in the plane at a point of a surface.
double arc_length(const grid& mesh, const surface& one, const position& x) {
  const int along = 1 - one.where.direction;
  if (one.solid < 0) return x[at(along)] - mesh.edge(along, 0);
  if (one.solid >= static_cast<int>(mesh.solids().size())) return 0.0;  // of a body: measure_around()
  const cell_box& box = mesh.solids()[at(one.solid)];
  const auto end = [&](int direction, bool upper) {
    const auto k = at(direction);
    return mesh.edge(direction, box.first[k] + (upper ? box.cells[k] : 0));
  };
  const double width = end(0, true) - end(0, false), height = end(1, true) - end(1, false);
  switch (face_beside(one).index()) {
    case 0:  // left, downwards
      return 2.0 * width + height + (end(1, true) - x[1]);
    case 1:  // right, upwards
      return width + (x[1] - end(1, false));
    case 2:  // bottom, to the right
      return x[0] - end(0, false);
    default:  // top, to the left
      return width + height + (end(0, true) - x[0]);
  }
}

/// Makes the tables of budget surfaces. The amounts of a surface begin at index `first`.
class surface_writer {
 public:
  surface_writer(const run_setup& setup, const domain& space, const surface_values& last)
      : space_(space),
        last_(last),
        invariants_(setup.equation->invariants()),
        loads_(*setup.equation, setup.config().output.reference),
        gas_(*setup.equation),
        one_way_(*setup.equation),
        of_walls_(*setup.equation) {
    for (const dimension& density : setup.equation->invariant_dimensions())
      fluxes_.push_back(density * dimensions::length / dimensions::time);
  }

  surface_table table(const std::string& name, const budget_surface& one, std::size_t first) const {
    surface_table table = with_columns(name);
    of_walls_.add_name(table, &space_.boundary_at(one));
    for (const int number : one.surfaces)
      for (std::size_t place = 0; place < space_.surfaces()[at(number)].segments.size(); ++place) {
        table.faces.push_back(face_names[face_beside(space_.surfaces()[at(number)]).index()]);
        table.corners.push_back(corners_of_end(space_, number, static_cast<int>(place)));
        table.numbers.rows.push_back(row(number, static_cast<int>(place), first));
        first += invariants_.size();
      }
    for (const int number : one.cut_faces) {
      table.faces.push_back(name);
      table.corners.push_back(space_.mesh().cut()->faces()[at(number)].corners);
      table.numbers.rows.push_back(row_of_cut_face(number, one, first));
      first += invariants_.size();
    }
    std::shared_ptr<const oblique_wall> wall;
    if (!one.walls.empty()) wall = space_.solid_boundary(one.solid)->oblique(space_.space().velocities);
    for (const int number : one.walls) {
      table.faces.emplace_back("wall");
      table.corners.push_back(space_.mesh().cut()->walls()[at(number)].corners);
      table.numbers.rows.push_back(row_of_wall(number, one, *wall, first));
      first += invariants_.size();
    }
    if (one.solid < 0 || !in_plane()) return table;
    if (is_body(one)) set_angles(table, middle_of(one));
    sort_by_first_column(table);
    if (is_body(one)) measure_around(table, space_.mesh());
    return table;
  }

 private:
  bool in_plane() const { return space_.mesh().dimensions() == 2; }

  surface_table with_columns(const std::string& name) const {
    surface_table table;
    table.name = name;
    const auto add = [&](const std::string& column, const dimension& dims) {
      table.numbers.columns.push_back(column);
      table.dimensions.push_back(dims);
    };
    const int dimensions = space_.mesh().dimensions();
    if (in_plane()) add("s", dimensions::length);
    for (int k = 0; k < dimensions; ++k) add(std::string(1, "xyz"[k]), dimensions::length);
    for (int k = 0; k < dimensions; ++k) add(component_name("n", k, dimensions), dimensions::none);
    dimension area = dimensions::none;
    for (int k = 1; k < dimensions; ++k) area = area * dimensions::length;
    add("area", area);
    for (std::size_t k = 0; k < invariants_.size(); ++k) add(invariants_[k], fluxes_[k]);
    loads_.add_names(table, fluxes_);
    gas_.add_names(table);
    one_way_.add_names(table, fluxes_);
    return table;
  }

  std::vector<double> row(int number, int place, std::size_t first) const {
    const surface& one = space_.surfaces()[at(number)];
    const position x = space_.meeting_point(number, place);
    const double area = of_ring(space_.mesh().face_area(one.where), x);
    const double s = in_plane() ? arc_length(space_.mesh(), one, x) : 0.0;
    const auto given = fluxes_at(first, area);
    std::vector<double> row = place_and_fluxes(s, x, normal_at(one.where), area, given);
    loads_.add_values(row, given, one.where, space_.side(number)->wall_velocity(middle_of_step(), x));
    add_state(row, first, space_.side(number), normal_at(one.where), x);
    return row;
  }

  std::vector<double> row_of_cut_face(int number, const budget_surface& of, std::size_t first) const {
    const open_face& one = space_.mesh().cut()->faces()[at(number)];
    const double s =
        in_plane() ? one.middle[at(1 - one.direction)] - space_.mesh().edge(1 - one.direction, 0) : 0.0;
    const double area = of_ring(one.area, one.middle);
    const auto given = fluxes_at(first, area);
    std::vector<double> row = place_and_fluxes(s, one.middle, normal_at(of.where), area, given);
    const int side = static_cast<int>(of.where.index());
    loads_.add_values(row, given, of.where, space_.side(side)->wall_velocity(middle_of_step(), one.middle));
    add_state(row, first, &space_.boundary_at(of), normal_at(of.where), one.middle);
    return row;
  }

  std::vector<double> row_of_wall(int number, const budget_surface& of, const oblique_wall& wall,
                                  std::size_t first) const {
    const wall_segment& one = space_.mesh().cut()->walls()[at(number)];
    const double area = of_ring(one.area, one.middle);
    const auto given = fluxes_at(first, area);
    std::vector<double> row = place_and_fluxes(0.0, one.middle, one.normal, area, given);
    loads_.add_values(row, given, one.normal, wall.velocity({one.normal, one.middle, middle_of_step()}));
    add_state(row, first, &space_.boundary_at(of), one.normal, one.middle);
    return row;
  }

  /// Returns the area of the ring that a surface element sweeps about an axis; without an
  /// axis, the area itself.
  double of_ring(double area, const position& x) const {
    return space_.mesh().measure() * space_.mesh().radius(x) * area;
  }

  double middle_of_step() const { return last_.t - 0.5 * last_.dt; }

  std::vector<double> fluxes_at(std::size_t first, double area) const {
    std::vector<double> given;
    for (std::size_t k = first; k < first + invariants_.size(); ++k)
      given.push_back(last_.received.empty() ? std::numeric_limits<double>::quiet_NaN()
                                             : (0.0 - last_.received[k]) / (area * last_.dt));
    return given;
  }

  /// Adds the state of the gas at the face whose amounts begin at `first`, the arriving and leaving fluxes,
  /// and the temperature of a wall.
  void add_state(std::vector<double>& row, std::size_t first, const boundary* side,
                 const std::array<double, 3>& n, const position& x) const {
    const double r = space_.mesh().radius(x);
    const auto moment = [&](std::size_t number) {
      const std::size_t count = invariants_.size();
      std::vector<double> of_f;
      if (last_.observed.empty()) return of_f;
      const auto begin = last_.observed.begin() +
                         static_cast<std::ptrdiff_t>(face_fluxes::observed_moments * first + number * count);
      of_f.assign(begin, begin + static_cast<std::ptrdiff_t>(count));
      for (double& one : of_f) one /= r;
      return of_f;
    };
    const auto density = moment(0), arriving = moment(1), leaving = moment(2);
    gas_.add_values(row, density);
    one_way_.add_values(row, arriving, leaving);
    of_walls_.add_value(row, side, {n, x, last_.t}, arriving);
  }

  /// Returns the normal into the gas at a face of cells.
  static std::array<double, 3> normal_at(const face& where) {
    std::array<double, 3> n{};
    n[at(where.direction)] = where.upper ? -1.0 : 1.0;
    return n;
  }

  std::vector<double> place_and_fluxes(double s, const position& x, const std::array<double, 3>& n,
                                       double area, const std::vector<double>& given) const {
    std::vector<double> row;
    if (in_plane()) row.push_back(s);
    row.insert(row.end(), x.begin(), x.begin() + space_.mesh().dimensions());
    row.insert(row.end(), n.begin(), n.begin() + space_.mesh().dimensions());
    row.push_back(area);
    row.insert(row.end(), given.begin(), given.end());
    return row;
  }

  bool is_body(const budget_surface& one) const {
    return one.solid >= static_cast<int>(space_.mesh().solids().size());
  }

  /// Returns the mean position of the surface of a body in the plane, weighted by length.
  position middle_of(const budget_surface& one) const {
    position mean{};
    double all = 0.0;
    const auto add = [&](double area, const position& x) {
      all += area;
      for (std::size_t k = 0; k < 2; ++k) mean[k] += area * x[k];
    };
    for (const int number : one.walls) {
      const wall_segment& wall = space_.mesh().cut()->walls()[at(number)];
      add(wall.area, wall.middle);
    }
    for (const int number : one.surfaces) {
      const surface& ends = space_.surfaces()[at(number)];
      for (int place = 0; place < static_cast<int>(ends.segments.size()); ++place)
        add(space_.mesh().face_area(ends.where), space_.meeting_point(number, place));
    }
    for (double& x : mean) x /= all;
    return mean;
  }

  /// Replaces the first column of the rows of a body by their angles around its middle, from 0 to 2π.
  void set_angles(surface_table& table, const position& middle) const {
    for (auto& row : table.numbers.rows) {
      const double angle = std::atan2(row[2] - middle[1], row[1] - middle[0]);
      row.front() = angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
    }
  }

  const domain& space_;
  const surface_values& last_;
  std::vector<std::string> invariants_;
  std::vector<dimension> fluxes_;  ///< dimensions of the fluxes of the invariants
  load_columns loads_;
  gas_columns gas_;
  one_way_columns one_way_;
  wall_temperature_column of_walls_;
};

}  // namespace

std::vector<surface_table> compute_surfaces(const run_setup& setup, const surface_values& last) {
  std::vector<surface_table> tables;
  const auto& wanted = setup.config().output.surfaces;
  if (wanted.empty()) return tables;
  const domain& space = setup.builder().whole_space();
  const surface_writer writer(setup, space, last);
  const auto names = setup.open_faces();
  const auto is_wanted = [&](const std::string& name) {
    return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
  };
  std::size_t first = 0;
  for (std::size_t k = 0; k < space.budget_surfaces().size(); ++k) {
    const budget_surface& one = space.budget_surfaces()[k];
    if (is_wanted(all_surfaces) || is_wanted(names[k])) tables.push_back(writer.table(names[k], one, first));
    first += space.ends_at(one) * setup.equation->invariants().size();
  }
  return tables;
}

}  // namespace apsis
