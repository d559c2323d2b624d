#include <apsis/semidiscrete/cut_transport.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/face_rows.hpp>

#include <algorithm>
#include <utility>

namespace apsis {
namespace {

/// Rows of scratch memory, named by their use.
enum scratch_row : int { outward_row, values_row, rate_row, inward_row, made_row, ghost_rows };

constexpr int groups_of_task = 4;

}  // namespace

void cut_transport::limit_for_steps(double step, aligned_vector<double> kept) {
  step_ = step;
  kept_ = std::move(kept);
  steady_ = false;
}

void cut_transport::limit_for_steady_states(double collisions, aligned_vector<double> rates) {
  for (double& rate : rates) rate = limiter::steady_inverse_cfl(rate, collisions) - 1.0;
  kept_ = std::move(rates);
  steady_ = true;
}

std::vector<int> cut_transport::cells_read() const {
  std::vector<int> cells = here_.sent_cells();
  const auto add = [&cells](int place) {
    if (place >= 0) cells.push_back(place);
  };
  for (const group& one : groups_) {
    add(one.place);
    for (const neighbour& other : one.around) add(other.place);
  }
  return cells;
}

cut_rows::gradient cut_transport::slopes_of(int number) {
  cut_rows::gradient slopes{};
  for (int d = 0; d < directions(); ++d) slopes[at(d)] = slopes_.row(number * directions() + d);
  return slopes;
}

/// Returns the line of a group at a vector from its centroid.
cut_rows::line cut_transport::line_of(const field& u, int number, const std::array<double, 3>& vector) {
  return {here_.row(u, groups_[at(number)].place), slopes_of(number), vector, limited_};
}

void cut_transport::make_scratch() {
  scratch_.prepare([&](scratch& own) {
    if (own.rows.cells() > 0) return;
    own.rows = field(ghost_rows + ghosts_, equation_.components());
    for (int g = 0; g < ghosts_; ++g) own.ghosts.push_back(own.rows.row(ghost_rows + g));
    own.seen.assign(own.ghosts.begin(), own.ghosts.end());
  });
}

void cut_transport::prepare(const field& u) {
  make_scratch();
  here_.exchange(u);
  if (flat_) return;
  parallel_blocks(static_cast<int>(groups_.size()), groups_of_task, [&](int begin, int end) {
    const profile::section timed(kernel::cut_cells, static_cast<double>(end - begin) * u.stride(), {});
    for (int number = begin; number < end; ++number) fit_group(u, number, scratch_.here());
  });
}

void cut_transport::fit_group(const field& u, int number, scratch& own) {
  const group& of = groups_[at(number)];
  const double* here = here_.row(u, of.place);
  const cut_rows::gradient slopes = slopes_of(number);
  own.around.clear();
  for (const neighbour& one : of.around) own.around.push_back({here_.row(u, one.place), one.weight});
  if (!limited_) return cut_rows::fit(here, own.around, size(), slopes);
  own.outlets.clear();
  for (const way& one : of.ways) own.outlets.push_back({out_by(one), one.from_centre});
  cut_rows::fit(here, own.around, {own.outlets, step_, kept_.data(), steady_}, size(), slopes);
}

const double* cut_transport::entering(int surface, int place, const field& u) {
  const auto& [number, way_number] = ends_[at(surface)][at(place)];
  const way& one = groups_[at(number)].ways[at(way_number)];
  double* values = scratch_.here().rows.row(values_row);
  cut_rows::leave_alone(out_by(one), line_of(u, number, one.from_centre), size(), values);
  return values;
}

void cut_transport::complete(int surface, int place, const field& u,
                             std::span<const target<field, double>> targets) {
  const double* values = entering(surface, place, u);
  const face where = space_->surfaces()[at(surface)].where;
  const int cell = space_->cell_at(surface, place);
  for (const auto& to : targets)
    face_rows::add_entering(inward_[where.index()].data(), values, to.beta,
                            space_->mesh().spacing(where.direction), equation_.components(),
                            to.acc->row(cell));
}

/// Returns the upwind values at the end of a segment at an open face.
const double* cut_transport::recorded_at(int f) {
  const open_face& one = cut().faces()[at(f)];
  const bool is_above = cut().group_of(one.below) < 0;  // the group lies above
  const int surface = border_at(one.direction, !is_above);
  const int cell = here_.number_here(is_above ? one.below : one.above);
  return faces_.recorded(surface, places_.at({surface, cell}));
}

void cut_transport::receive_values_at_faces() {
  make_scratch();
  here_.exchange_at_faces(equation_.components(), [&](int f) { return recorded_at(f); });
}

/// Calls receive(cells, rate) for some groups with cells of this process.
template <class Receive>
void cut_transport::evaluate_groups(double t, const field& u, const Receive& receive, int begin, int end) {
  scratch& own = scratch_.here();
  double* rate = own.rows.row(rate_row);
  for (int number = begin; number < end; ++number) {
    if (groups_[at(number)].cells.empty()) continue;
    add_group(t, u, number, rate, own);
    receive(groups_[at(number)].cells, rate);
  }
}

void cut_transport::evaluate(double t, const field& u, const receiver& receive) {
  receive_values_at_faces();
  parallel_blocks(static_cast<int>(groups_.size()), groups_of_task, [&](int begin, int end) {
    const profile::section timed(kernel::cut_cells, static_cast<double>(end - begin) * u.stride(), {});
    evaluate_groups(t, u, receive, begin, end);
  });
}

void cut_transport::add(double t, const field& u, std::span<const target<field, double>> targets,
                        const cells_job& then) {
  const auto receive = [&](const std::vector<int>& cells, const double* rate) {
    for (const int cell : cells)
      for (const auto& to : targets)
        cut_rows::add(u.row(cell), rate, to.alpha, to.beta, to.fresh, equation_.components(),
                      to.acc->row(cell));
  };
  receive_values_at_faces();
  parallel_blocks(static_cast<int>(groups_.size()), groups_of_task, [&](int begin, int end) {
    {
      const profile::section timed(kernel::cut_cells, static_cast<double>(end - begin) * u.stride(),
                                   traffic(targets));
      evaluate_groups(t, u, receive, begin, end);
    }
    if (!then) return;
    for (int number = begin; number < end; ++number)
      for (const int cell : groups_[at(number)].cells) then(cell, cell + 1);
  });
}

void cut_transport::add_group(double t, const field& u, int number, double* rate, scratch& own) {
  std::fill_n(rate, equation_.components(), 0.0);
  own.crossings.clear();
  const auto pass_crossings = [&] {
    if (!own.crossings.empty()) cut_rows::pass(own.crossings, line_of(u, number, {}), size(), rate);
    own.crossings.clear();
  };
  for (const way& one : groups_[at(number)].ways) {
    if (one.to == way::kind::whole || one.to == way::kind::group) {
      own.crossings.push_back({out_by(one), one.from_centre, beyond(u, one)});
    } else {
      pass_crossings();
      pass_end(t, one, line_of(u, number, one.from_centre), rate, own);
    }
  }
  pass_crossings();
}

/// Returns the line of the other group, or the value of a whole cell at the face.
cut_rows::line cut_transport::beyond(const field& u, const way& one) {
  if (one.to == way::kind::group) return line_of(u, one.number, one.from_other);
  return {one.surface >= 0 ? faces_.recorded(one.surface, one.number) : here_.values_at_face(one.number),
          {},
          {},
          limited_};
}

/// Adds the flux through a face of the domain or a wall, and its contribution to the boundary budget.
void cut_transport::pass_end(double t, const way& one, const cut_rows::line& here, double* rate,
                             scratch& own) {
  const int n = equation_.components();
  double *outward = own.rows.row(outward_row), *values = own.rows.row(values_row),
         *inward = own.rows.row(inward_row);
  cut_rows::project(out_by(one), size(), outward);
  std::copy_n(here.value, n, values);  // kept for components along the wall
  cut_rows::leave(outward, here, size(), values);
  if (one.to == way::kind::domain) {
    domain_values(t, one, values, own);
    faces_.receive_through(one.number, inward_[at(one.surface)], values, own.rows.row(inward_row));
  } else {
    const wall_segment& wall = cut().walls()[at(one.number)];
    cut_rows::project({wall.normal, 1.0, speeds_}, size(), inward);
    double* emitted = own.rows.row(ghost_rows);
    walls_[at(wall.solid)]->emit({wall.normal, wall.middle, t}, inward, values, emitted);
    face_rows::take_entering(inward, emitted, n, values);
    faces_.receive_at_wall(one.number, {inward, at(n)}, values, emitted);
  }
  cut_rows::take(outward, values, n, rate);
}

/// Replaces the values that enter through a face of the domain. The boundary gets a single cell with the
/// values at the face.
void cut_transport::domain_values(double t, const way& one, double* values, scratch& own) {
  const face where = face_of(at(one.surface));
  const boundary& side = *space_->side(one.surface);
  const int n = equation_.components();
  const double* inside = values;
  const position x = cut().faces()[at(one.number)].middle;
  side.fill(where, t, {{&inside, 1}, own.ghosts, space_->space().velocities, n, x});
  const double* entering = own.ghosts.front();
  double* outgoing = own.rows.row(inward_row);
  // The boundary gets only this cell.
  if (side.prescribes_incoming(1, static_cast<int>(own.ghosts.size()))) {
    std::copy_n(values, n, outgoing);
    face_rows::keep_leaving(inward_[where.index()].data(), n, outgoing);
    double* made = own.rows.row(made_row);
    side.incoming_given_outgoing(where, t, x, outgoing, own.seen, made);
    entering = made;
  }
  face_rows::take_entering(inward_[where.index()].data(), entering, n, values);
}

}  // namespace apsis
