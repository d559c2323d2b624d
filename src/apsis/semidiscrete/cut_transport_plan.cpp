#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/semidiscrete/cut_gradient.hpp>
#include <apsis/semidiscrete/cut_transport.hpp>

#include <algorithm>
#include <utility>

namespace apsis {
cut_transport::cut_transport(const model& equation, std::shared_ptr<domain> space,
                             const limited_reconstruction& edges, face_fluxes& faces)
    : equation_(equation),
      space_(std::move(space)),
      faces_(faces),
      here_(*space_),
      flat_(edges.scheme->order() == 1),
      limited_(edges.keeps_sign()),
      ghosts_(edges.ghosts()),
      number_of_(cut().groups().size(), -1) {
  for (int d = 0; d < directions(); ++d) {
    speeds_[at(d)] = equation.speeds(d).data();
    for (const bool upper : {false, true})
      for (const double v : equation.speeds(d)) inward_[face{d, upper}.index()].push_back(upper ? -v : v);
  }
  find_walls();
  find_places_at_border();
  for (const int number : here_.fitted()) {
    number_of_[at(number)] = static_cast<int>(groups_.size());
    groups_.push_back(
        {here_.place_of(cut().groups()[at(number)].cells.front()), here_.cells_here(number), {}, {}});
  }
  for (const int number : here_.fitted()) {
    add_ways(number);
    add_neighbours(number);
  }
  slopes_ = field(static_cast<int>(groups_.size()) * directions(), equation_.components());
}

void cut_transport::find_walls() {
  const velocity_set velocities = space_->space().velocities;
  for (int solid = 0; solid < space_->mesh().obstacles(); ++solid) {
    const bool is_needed = std::any_of(cut().walls().begin(), cut().walls().end(),
                                       [&](const wall_segment& one) { return one.solid == solid; });
    walls_.push_back(is_needed ? space_->solid_boundary(solid)->oblique(velocities) : nullptr);
    if (is_needed && !walls_.back())
      throw input_error(
          "a boundary of a body that serves faces of cells alone (a curved body has any normal); use a "
          "diffuse wall, symmetry, or vacuum");
  }
}

void cut_transport::find_places_at_border() {
  const int surfaces = static_cast<int>(space_->surfaces().size());
  ends_.resize(at(surfaces));
  for (int number = 0; number < surfaces; ++number) {
    if (!space_->is_border_of_cut_cells(number)) continue;
    const int own = space_->surfaces()[at(number)].own;
    ends_[at(number)].resize(at(own));
    for (int place = 0; place < own; ++place) places_[{number, space_->cell_at(number, place)}] = place;
  }
}

/// Finds the faces and walls through which the gas of a group may leave.
void cut_transport::add_ways(int number) {
  const cut_group& from = cut().groups()[at(number)];
  const int index = number_of_[at(number)];
  group& to = groups_[at(index)];
  for (const int f : from.faces) {
    const way made = way_through(number, f);
    if (made.to == way::kind::whole && made.surface >= 0)
      ends_[at(made.surface)][at(made.number)] = {index, static_cast<int>(to.ways.size())};
    to.ways.push_back(made);
  }
  for (const int w : from.walls) {
    const wall_segment& one = cut().walls()[at(w)];
    way made{way::kind::wall, w, {}, one.from_centre};
    made.normal = one.normal;
    made.rate = -one.area / from.volume;
    to.ways.push_back(made);
  }
}

void cut_transport::use_chords() {
  for (group& one : groups_)
    for (way& wall : one.ways) {
      if (wall.to != way::kind::wall) continue;
      const wall_segment& piece = cut().walls()[at(wall.number)];
      for (int d = 0; d < directions(); ++d)
        wall.from_centre[at(d)] = piece.from_centre[at(d)] - piece.middle[at(d)] +
                                  0.5 * (piece.corners.front()[at(d)] + piece.corners.back()[at(d)]);
    }
}

/// Returns the surface at which segments end next to cut cells.
int cut_transport::border_at(int direction, bool cut_is_below) const {
  return 2 * directions() * (space_->mesh().obstacles() + 1) +
         static_cast<int>(face{direction, cut_is_below}.index());
}

/// Returns the way out of a group through one of its faces.
cut_transport::way cut_transport::way_through(int number, int f) const {
  const open_face& one = cut().faces()[at(f)];
  const bool is_below = one.below >= 0 && cut().group_of(one.below) == number;
  const int other = is_below ? one.above : one.below;
  way made{way::kind::domain,
           f,
           {},
           is_below ? one.from_below : one.from_above,
           is_below ? one.from_above : one.from_below};
  made.normal[at(one.direction)] = is_below ? 1.0 : -1.0;
  made.rate = one.area / cut().groups()[at(number)].volume;
  made.surface = static_cast<int>(face{one.direction, is_below}.index());
  if (other < 0) return made;
  if (const int group_of = cut().group_of(other); group_of >= 0) {
    made.to = way::kind::group;
    made.number = number_of_[at(group_of)];
    return made;
  }
  // A segment of whole cells begins or ends here.
  made.to = way::kind::whole;
  if (const int cell = here_.number_here(other); cell >= 0) {
    made.surface = border_at(one.direction, is_below);
    made.number = places_.at({made.surface, cell});
  } else {
    const bool has_cells = !groups_[at(number_of_[at(number)])].cells.empty();
    made.surface = -1;
    made.number = has_cells ? here_.place_of_face(f) : -1;
  }
  return made;
}

/// Computes the weights of the neighbours in the slopes of a group.
void cut_transport::add_neighbours(int number) {
  for (const auto& [cell, weight] : gradient_weights(cut(), number))
    groups_[at(number_of_[at(number)])].around.push_back({here_.place_of(cell), weight});
}

}  // namespace apsis
