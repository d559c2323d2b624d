#include <apsis/run/compute_surfaces.hpp>

#include <apsis/core/index.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/velocity/component_name.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace apsis {
namespace {

std::optional<std::size_t> place_of_name(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

/// The columns that are derived from the invariants.
struct derived_columns {
  std::vector<std::size_t> momenta;   ///< of each velocity dimension; empty if the model has none
  std::optional<std::size_t> energy;  ///< nothing without momenta

  explicit derived_columns(const model& equation) {
    const auto names = equation.invariants();
    const int dimensions = equation.velocities().dimensions();
    for (int k = 0; k < dimensions; ++k)
      if (const auto found = place_of_name(names, component_name("momentum", k, dimensions)))
        momenta.push_back(*found);
    if (momenta.size() < at(dimensions)) momenta.clear();
    if (!momenta.empty()) energy = place_of_name(names, "energy");
  }

  /// Adds the names, and the dimensions given those of the fluxes of the invariants.
  void add_names(surface_table& table, const std::vector<dimension>& fluxes) const {
    const auto add = [&](const char* name, std::size_t invariant) {
      table.numbers.columns.emplace_back(name);
      table.dimensions.push_back(fluxes[invariant]);
    };
    if (momenta.empty()) return;
    add("pressure", momenta.front());
    if (momenta.size() > 1) add("shear_stress", momenta.front());
    if (energy) add("heat_flux", *energy);
  }

  /// The same at a wall with the normal n into the gas. In the plane the component along it is that
  /// counter-clockwise around the body.
  void add_values(std::vector<double>& row, const std::vector<double>& given, const std::array<double, 3>& n,
                  const std::array<double, 3>& wall_velocity) const {
    if (momenta.empty()) return;
    double normal = 0.0, square = 0.0, work = 0.0;
    for (std::size_t k = 0; k < momenta.size(); ++k) {
      normal += given[momenta[k]] * n[k];
      work += wall_velocity[k] * given[momenta[k]];
    }
    row.push_back(-normal);
    for (std::size_t k = 0; k < momenta.size(); ++k) {
      const double along = given[momenta[k]] - normal * n[k];
      square += along * along;
    }
    if (momenta.size() == 2) row.push_back(n[0] * given[momenta[1]] - n[1] * given[momenta[0]]);
    if (momenta.size() == 3) row.push_back(std::sqrt(square));
    if (energy) row.push_back(given[*energy] - work);
  }

  /// Appends the values for the given fluxes of the invariants.
  void add_values(std::vector<double>& row, const std::vector<double>& given, const face& where,
                  const std::array<double, 3>& wall_velocity) const {
    if (momenta.empty()) return;
    const double normal = given[momenta[at(where.direction)]];
    row.push_back(where.upper ? normal : -normal);
    std::vector<double> along;
    double work = 0.0;
    for (std::size_t k = 0; k < momenta.size(); ++k) {
      if (k != at(where.direction)) along.push_back(given[momenta[k]]);
      work += wall_velocity[k] * given[momenta[k]];
    }
    if (along.size() == 1) row.push_back(along.front());
    if (along.size() == 2) row.push_back(std::hypot(along[0], along[1]));
    if (energy) row.push_back(given[*energy] - work);
  }
};

/// The columns of the state of a gas; none for other models.
class gas_columns {
 public:
  explicit gas_columns(const model& equation) : gas_(equation.as_gas()) {}

  void add_names(surface_table& table) const {
    const auto add = [&](const std::string& name, const dimension& dims) {
      table.numbers.columns.push_back(name);
      table.dimensions.push_back(dims);
    };
    if (gas_ == nullptr) return;
    add("rho", dimensions::density);
    for (int k = 0; k < directions(); ++k) add(component_name("u", k, directions()), dimensions::velocity);
    add("T", dimensions::temperature);
  }

  /// Appends the values for the densities of the invariants, which are the moments of a gas.
  void add_values(std::vector<double>& row, std::span<const double> moments) const {
    if (gas_ == nullptr) return;
    fluid_state state;
    if (!moments.empty()) state = gas_->molecules().state(moments.data());
    if (!state.admissible()) {
      row.insert(row.end(), at(directions()) + 2, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    row.push_back(state.rho);
    row.insert(row.end(), state.u, state.u + directions());
    row.push_back(state.T);
  }

 private:
  int directions() const { return gas_->molecules().dimensions(); }

  const gas_model* gas_;
};

/// The face of the domain at which a surface is, or the face of a box: it is the upper one where segments
/// begin.
face face_beside(const surface& one) {
  return {one.where.direction, one.solid < 0 ? one.where.upper : !one.where.upper};
}

/// Arc length in the plane at a point of a surface.
double arc_length(const grid& mesh, const surface& one, const position& x) {
  const int along = 1 - one.where.direction;
  if (one.solid < 0) return x[at(along)] - mesh.edge(along, 0);
  if (one.solid >= static_cast<int>(mesh.solids().size()))
    return 0.0;  // a body, whose rows get another measure
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

/// The table of one budget surface, whose amounts begin at `first`.
class surface_writer {
 public:
  surface_writer(const run_setup& setup, const domain& space, const surface_values& last)
      : space_(space),
        last_(last),
        invariants_(setup.equation->invariants()),
        derived_(*setup.equation),
        gas_(*setup.equation) {
    for (const dimension& density : setup.equation->invariant_dimensions())
      fluxes_.push_back(density * dimensions::length / dimensions::time);
  }

  surface_table table(const std::string& name, const budget_surface& one, std::size_t first) const {
    surface_table table = with_columns(name);
    for (const int number : one.surfaces)
      for (std::size_t place = 0; place < space_.surfaces()[at(number)].segments.size(); ++place) {
        table.faces.push_back(face_names[face_beside(space_.surfaces()[at(number)]).index()]);
        table.numbers.rows.push_back(row(number, static_cast<int>(place), first));
        first += invariants_.size();
      }
    for (const int number : one.cut_faces) {
      table.faces.push_back(name);
      table.numbers.rows.push_back(row_of_cut_face(number, one, first));
      first += invariants_.size();
    }
    std::shared_ptr<const oblique_wall> wall;
    if (!one.walls.empty()) wall = space_.solid_boundary(one.solid)->oblique(space_.space().velocities);
    for (const int number : one.walls) {
      table.faces.emplace_back("wall");
      table.numbers.rows.push_back(row_of_wall(number, *wall, first));
      first += invariants_.size();
    }
    if (one.solid >= 0 && in_plane()) sort_along(table);
    if (!one.walls.empty() && in_plane()) measure_around(table);
    return table;
  }

 private:
  bool in_plane() const { return space_.mesh().dimensions() == 2; }

  surface_table with_columns(const std::string& name) const {
    surface_table table{name, {}, {}};
    const auto add = [&](const std::string& column, const dimension& dims) {
      table.numbers.columns.push_back(column);
      table.dimensions.push_back(dims);
    };
    const int dimensions = space_.mesh().dimensions();
    if (in_plane()) add("s", dimensions::length);
    for (int k = 0; k < dimensions; ++k) add(std::string(1, "xyz"[k]), dimensions::length);
    dimension area = dimensions::none;
    for (int k = 1; k < dimensions; ++k) area = area * dimensions::length;
    add("area", area);
    for (std::size_t k = 0; k < invariants_.size(); ++k) add(invariants_[k], fluxes_[k]);
    derived_.add_names(table, fluxes_);
    gas_.add_names(table);
    return table;
  }

  std::vector<double> row(int number, int place, std::size_t first) const {
    const surface& one = space_.surfaces()[at(number)];
    const position x = space_.meeting_point(number, place);
    const double area = space_.mesh().face_area(one.where);
    const double s = in_plane() ? arc_length(space_.mesh(), one, x) : 0.0;
    const auto given = fluxes_at(first, area);
    std::vector<double> row = place_and_fluxes(s, x, area, given);
    derived_.add_values(row, given, one.where, space_.side(number)->wall_velocity(middle_of_step(), x));
    gas_.add_values(row, densities_at(first));
    return row;
  }

  std::vector<double> row_of_cut_face(int number, const budget_surface& of, std::size_t first) const {
    const open_face& one = space_.mesh().cut()->faces()[at(number)];
    const double s =
        in_plane() ? one.middle[at(1 - one.direction)] - space_.mesh().edge(1 - one.direction, 0) : 0.0;
    const auto given = fluxes_at(first, one.area);
    std::vector<double> row = place_and_fluxes(s, one.middle, one.area, given);
    const int side = static_cast<int>(of.where.index());
    derived_.add_values(row, given, of.where, space_.side(side)->wall_velocity(middle_of_step(), one.middle));
    gas_.add_values(row, densities_at(first));
    return row;
  }

  /// The first column is the angle around the middle of the body, until measure_around().
  std::vector<double> row_of_wall(int number, const oblique_wall& wall, std::size_t first) const {
    const wall_segment& one = space_.mesh().cut()->walls()[at(number)];
    const auto given = fluxes_at(first, one.area);
    std::vector<double> row = place_and_fluxes(angle_around(one), one.middle, one.area, given);
    derived_.add_values(row, given, one.normal, wall.velocity({one.normal, one.middle, middle_of_step()}));
    gas_.add_values(row, densities_at(first));
    return row;
  }

  double middle_of_step() const { return last_.t - 0.5 * last_.dt; }

  std::vector<double> fluxes_at(std::size_t first, double area) const {
    std::vector<double> given;
    for (std::size_t k = first; k < first + invariants_.size(); ++k)
      given.push_back(last_.received.empty() ? std::numeric_limits<double>::quiet_NaN()
                                             : (0.0 - last_.received[k]) / (area * last_.dt));
    return given;
  }

  std::span<const double> densities_at(std::size_t first) const {
    return last_.densities.empty() ? std::span<const double>()
                                   : std::span(last_.densities).subspan(first, invariants_.size());
  }

  std::vector<double> place_and_fluxes(double s, const position& x, double area,
                                       const std::vector<double>& given) const {
    std::vector<double> row;
    if (in_plane()) row.push_back(s);
    row.insert(row.end(), x.begin(), x.begin() + space_.mesh().dimensions());
    row.push_back(area);
    row.insert(row.end(), given.begin(), given.end());
    return row;
  }

  /// Returns the angle of a wall around the mean of the walls of its body, from 0 to 2π.
  double angle_around(const wall_segment& one) const {
    position mean{};
    double area = 0.0;
    for (const wall_segment& other : space_.mesh().cut()->walls()) {
      if (other.solid != one.solid) continue;
      area += other.area;
      for (std::size_t k = 0; k < 2; ++k) mean[k] += other.area * other.middle[k];
    }
    const double angle = std::atan2(one.middle[1] - mean[1] / area, one.middle[0] - mean[0] / area);
    return angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle;
  }

  /// Begins with the first piece counter-clockwise of an opening of the wall, where it ends at a face of the
  /// domain.
  static void begin_after_gap(surface_table& table) {
    constexpr double least_gap = std::numbers::pi / 3.0;
    auto& rows = table.numbers.rows;
    std::size_t first = 0;
    double widest = rows.front().front() + 2.0 * std::numbers::pi - rows.back().front();
    for (std::size_t k = 1; k < rows.size(); ++k)
      if (const double gap = rows[k].front() - rows[k - 1].front(); gap > widest) {
        widest = gap;
        first = k;
      }
    if (widest < least_gap) return;
    const auto from = static_cast<std::ptrdiff_t>(first);
    std::rotate(rows.begin(), rows.begin() + from, rows.end());
    std::rotate(table.faces.begin(), table.faces.begin() + from, table.faces.end());
  }

  /// Replaces the angles of sorted rows by lengths along the wall, to the middle of each piece.
  void measure_around(surface_table& table) const {
    const auto column = std::find(table.numbers.columns.begin(), table.numbers.columns.end(), "area");
    const auto area = static_cast<std::size_t>(column - table.numbers.columns.begin());
    begin_after_gap(table);
    double length = 0.0;
    for (auto& row : table.numbers.rows) {
      row.front() = length + 0.5 * row[area];
      length += row[area];
    }
  }

  /// Sorts the rows by s.
  static void sort_along(surface_table& table) {
    std::vector<std::size_t> order(table.faces.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto& rows = table.numbers.rows;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return rows[a].front() < rows[b].front(); });
    surface_table sorted{table.name, {}, {table.numbers.columns, {}}, table.dimensions};
    for (const std::size_t k : order) {
      sorted.faces.push_back(table.faces[k]);
      sorted.numbers.rows.push_back(rows[k]);
    }
    table = std::move(sorted);
  }

  const domain& space_;
  const surface_values& last_;
  std::vector<std::string> invariants_;
  std::vector<dimension> fluxes_;  ///< dimensions of the fluxes of the invariants
  derived_columns derived_;
  gas_columns gas_;
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
