#include <apsis/semidiscrete/cut_transport.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/semidiscrete/block_sweep.hpp>
#include <apsis/semidiscrete/face_rows.hpp>

#include <algorithm>
#include <map>
#include <utility>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

namespace apsis {
namespace {

/// Rows of scratch memory, by their use.
enum scratch_row : int {
  outward_row,
  values_row,
  rate_row,
  inward_row,
  lowest_row,
  size_row,
  outflow_row,
  increase_row,
  ghost_rows
};

constexpr int groups_of_task = 4;

/// Directions in which neighbours lie less than this share apart, of the most, have no slope.
constexpr double least_spread = 1e-3;

/// Returns the pseudoinverse of a symmetric matrix of least squares.
Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of(m);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k)
    if (of.eigenvalues()[k] > least_spread * of.eigenvalues()[2])
      inverse += of.eigenvectors().col(k) * of.eigenvectors().col(k).transpose() / of.eigenvalues()[k];
  return inverse;
}

}  // namespace

cut_transport::cut_transport(const model& equation, std::shared_ptr<domain> space,
                             const limited_reconstruction& edges, face_fluxes& faces)
    : equation_(equation),
      space_(std::move(space)),
      faces_(faces),
      flat_(edges.scheme->order() == 1),
      limited_(edges.keeps_sign()),
      ghosts_(edges.ghosts()) {
  for (int d = 0; d < directions(); ++d) {
    speeds_[at(d)] = equation.speeds(d).data();
    for (const bool upper : {false, true})
      for (const double v : equation.speeds(d)) inward_[face{d, upper}.index()].push_back(upper ? -v : v);
  }
  const velocity_set velocities = space_->space().velocities;
  for (int solid = 0; solid < space_->mesh().obstacles(); ++solid) {
    const bool is_needed = std::any_of(cut().walls().begin(), cut().walls().end(),
                                       [&](const wall_segment& one) { return one.solid == solid; });
    walls_.push_back(is_needed ? space_->solid_boundary(solid)->oblique(velocities) : nullptr);
    if (is_needed && !walls_.back())
      throw input_error(
          "a boundary of a body that serves faces of cells alone (a curved body has any normal); use a "
          "diffuse wall, or symmetry");
  }
  ends_.resize(space_->surfaces().size());
  groups_.resize(cut().groups().size());
  for (int number = 0; number < static_cast<int>(groups_.size()); ++number) {
    add_ways(number);
    add_neighbours(number);
  }
  slopes_ = field(static_cast<int>(groups_.size()) * directions(), equation_.components());
}

/// Finds where the gas of a group may go.
void cut_transport::add_ways(int number) {
  const cut_group& from = cut().groups()[at(number)];
  group& to = groups_[at(number)];
  to.cell = from.cells.front();
  const auto add = [&](way one) { to.ways.push_back(one); };
  for (const int f : from.faces) {
    const open_face& one = cut().faces()[at(f)];
    const bool is_below = one.below >= 0 && cut().group_of(one.below) == number;
    const int other = is_below ? one.above : one.below;
    way made{way::kind::domain,
             f,
             {},
             is_below ? one.from_below : one.from_above,
             is_below ? one.from_above : one.from_below};
    made.normal[at(one.direction)] = is_below ? 1.0 : -1.0;
    made.rate = one.area / from.volume;
    made.surface = static_cast<int>(face{one.direction, is_below}.index());
    if (other >= 0 && cut().group_of(other) >= 0) {
      made.to = way::kind::group;
      made.number = cut().group_of(other);
    } else if (other >= 0) {
      // A segment of whole cells begins or ends here.
      made.to = way::kind::whole;
      made.surface += 2 * directions() * (space_->mesh().obstacles() + 1);
      const surface& border = space_->surfaces()[at(made.surface)];
      auto& ends = ends_[at(made.surface)];
      ends.resize(border.segments.size());
      for (int place = 0; place < static_cast<int>(border.segments.size()); ++place)
        if (space_->cell_at(made.surface, place) == other) made.number = place;
      ends[at(made.number)] = {number, static_cast<int>(to.ways.size())};
    }
    add(made);
  }
  for (const int w : from.walls) {
    const wall_segment& one = cut().walls()[at(w)];
    way made{way::kind::wall, w, {}, one.from_centre};
    made.normal = one.normal;
    made.rate = -one.area / from.volume;
    add(made);
  }
}

/// Finds the weights of the neighbours in the slopes of a group.
void cut_transport::add_neighbours(int number) {
  const cut_group& from = cut().groups()[at(number)];
  std::map<int, Eigen::Vector3d> around;  // vectors to their centroids, by their first cells
  for (const int f : from.faces) {
    const open_face& one = cut().faces()[at(f)];
    const bool is_below = one.below >= 0 && cut().group_of(one.below) == number;
    const int other = is_below ? one.above : one.below;
    if (other < 0) continue;
    const int group_of = cut().group_of(other);
    Eigen::Vector3d apart;
    for (int k = 0; k < 3; ++k)
      apart[k] = (is_below ? 1.0 : -1.0) * (one.from_below[at(k)] - one.from_above[at(k)]);
    around.emplace(group_of < 0 ? other : cut().groups()[at(group_of)].cells.front(), apart);
  }
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const auto& [cell, apart] : around) squares += apart * apart.transpose() / apart.squaredNorm();
  if (around.empty()) return;
  const Eigen::Matrix3d inverse = pseudo_inverse(squares);
  for (const auto& [cell, apart] : around) {
    const Eigen::Vector3d weight = inverse * apart / apart.squaredNorm();
    groups_[at(number)].around.push_back({cell, {weight[0], weight[1], weight[2]}});
  }
}

void cut_transport::limit_for_steps(double step, double kept) {
  step_ = step;
  kept_ = kept;
}

cut_rows::gradient cut_transport::lines_of(int number) {
  cut_rows::gradient slopes{};
  for (int d = 0; d < directions(); ++d) slopes[at(d)] = slopes_.row(number * directions() + d);
  return slopes;
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
  if (flat_) return;
  parallel_blocks(static_cast<int>(groups_.size()), groups_of_task, [&](int begin, int end) {
    const profile::section timed(kernel::edges, static_cast<double>(end - begin) * u.stride(), {});
    for (int number = begin; number < end; ++number) fit_group(u, number, scratch_.here());
  });
}

void cut_transport::fit_group(const field& u, int number, scratch& own) {
  const group& of = groups_[at(number)];
  const int n = equation_.components();
  const double* here = u.row(of.cell);
  const cut_rows::gradient slopes = lines_of(number);
  own.around.clear();
  for (const neighbour& one : of.around) own.around.push_back({u.row(one.cell), one.weight});
  cut_rows::fit(here, own.around, directions(), n, slopes);
  if (!limited_) return;
  const cut_rows::demand_rows demand{own.rows.row(lowest_row), own.rows.row(size_row),
                                     own.rows.row(outflow_row), own.rows.row(increase_row)};
  for (double* row : {demand.lowest, demand.size, demand.outflow, demand.increase}) std::fill_n(row, n, 0.0);
  double* outward = own.rows.row(outward_row);
  for (const way& one : of.ways) {
    cut_rows::project(one.normal, one.rate, speeds_, directions(), n, outward);
    cut_rows::add_demand(outward, step_, slopes, one.from_centre, directions(), n, demand);
  }
  cut_rows::limit(here, demand, kept_, directions(), n, slopes);
}

void cut_transport::complete(int surface, int place, const field& u,
                             std::span<const target<field, double>> targets) {
  const auto& [number, way_number] = ends_[at(surface)][at(place)];
  const group& of = groups_[at(number)];
  const way& one = of.ways[at(way_number)];
  scratch& own = scratch_.here();
  const int n = equation_.components();
  double *outward = own.rows.row(outward_row), *values = own.rows.row(values_row);
  std::fill_n(values, n, 0.0);
  cut_rows::project(one.normal, one.rate, speeds_, directions(), n, outward);
  cut_rows::leave(u.row(of.cell), outward, lines_of(number), one.from_centre, directions(), n, values);
  const face where = space_->surfaces()[at(surface)].where;
  const int cell = space_->cell_at(surface, place);
  for (const auto& to : targets)
    face_rows::add_entering(inward_[where.index()].data(), values, to.beta,
                            space_->mesh().spacing(where.direction), n, to.acc->row(cell));
}

void cut_transport::add(double t, const field& u, std::span<const target<field, double>> targets,
                        const cells_job& then) {
  make_scratch();
  parallel_blocks(static_cast<int>(groups_.size()), groups_of_task, [&](int begin, int end) {
    const profile::section timed(kernel::walls, static_cast<double>(end - begin) * u.stride(),
                                 traffic(targets));
    for (int number = begin; number < end; ++number) {
      scratch& own = scratch_.here();
      double* rate = own.rows.row(rate_row);
      add_group(t, u, number, rate, own);
      for (const int cell : cut().groups()[at(number)].cells) {
        for (const auto& to : targets)
          cut_rows::add(u.row(cell), rate, to.alpha, to.beta, to.fresh, equation_.components(),
                        to.acc->row(cell));
        if (then) then(cell, cell + 1);
      }
    }
  });
}

void cut_transport::add_group(double t, const field& u, int number, double* rate, scratch& own) {
  const group& of = groups_[at(number)];
  std::fill_n(rate, equation_.components(), 0.0);
  for (const way& one : of.ways) add_way(t, u, of, number, one, rate, own);
}

void cut_transport::add_way(double t, const field& u, const group& of, int number, const way& one,
                            double* rate, scratch& own) {
  const int n = equation_.components();
  double *outward = own.rows.row(outward_row), *values = own.rows.row(values_row),
         *inward = own.rows.row(inward_row);
  cut_rows::project(one.normal, one.rate, speeds_, directions(), n, outward);
  const double* here = u.row(of.cell);
  std::copy_n(here, n, values);
  switch (one.to) {
    case way::kind::whole:
      std::copy_n(faces_.recorded(one.surface, one.number), n, values);
      break;
    case way::kind::group: {
      for (int k = 0; k < n; ++k) inward[k] = -outward[k];
      cut_rows::leave(u.row(groups_[at(one.number)].cell), inward, lines_of(one.number), one.from_other,
                      directions(), n, values);
      break;
    }
    default:
      break;
  }
  cut_rows::leave(here, outward, lines_of(number), one.from_centre, directions(), n, values);
  if (one.to == way::kind::domain) {
    domain_values(t, one, values, own);
    faces_.receive_through(one.number, inward_[at(one.surface)], values, own.rows.row(inward_row));
  }
  if (one.to == way::kind::wall) {
    const wall_segment& wall = cut().walls()[at(one.number)];
    cut_rows::project(one.normal, 1.0, speeds_, directions(), n, inward);
    double* emitted = own.rows.row(ghost_rows);
    walls_[at(wall.solid)]->emit({wall.normal, wall.middle, t}, inward, values, emitted);
    face_rows::take_entering(inward, emitted, n, values);
    faces_.receive_at_wall(one.number, {inward, at(n)}, values, emitted);
  }
  cut_rows::take(outward, values, n, rate);
}

/// Replaces the values that enter through a face of the domain. A boundary sees a cell with the values at the
/// face.
void cut_transport::domain_values(double t, const way& one, double* values, scratch& own) {
  const face where = face_of(at(one.surface));
  const boundary& side = *space_->side(one.surface);
  const int n = equation_.components();
  const double* inside = values;
  const position x = cut().faces()[at(one.number)].middle;
  side.fill(where, t, {{&inside, 1}, own.ghosts, space_->space().velocities, n, x});
  const double* entering = own.ghosts.front();
  double* outgoing = own.rows.row(inward_row);
  if (side.prescribes_incoming()) {
    std::copy_n(values, n, outgoing);
    face_rows::keep_leaving(inward_[where.index()].data(), n, outgoing);
    double* made = own.rows.row(lowest_row);
    side.incoming_given_outgoing(where, t, x, outgoing, own.seen, made);
    entering = made;
  }
  face_rows::take_entering(inward_[where.index()].data(), entering, n, values);
}

}  // namespace apsis
