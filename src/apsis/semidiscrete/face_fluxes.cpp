#include <apsis/semidiscrete/face_fluxes.hpp>

#include <apsis/mesh/cut_cells.hpp>
#include <apsis/semidiscrete/face_rows.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace apsis {
namespace {

/// The end of an open face or wall with a cell of another process.
constexpr std::size_t of_others = static_cast<std::size_t>(-1);

std::size_t index(int k) {
  return static_cast<std::size_t>(k);
}

}  // namespace

face_fluxes::face_fluxes(const model& equation, std::shared_ptr<domain> space)
    : equation_(equation), space_(std::move(space)), invariants_(equation.invariants().size()) {
  sides_.resize(space_->surfaces().size());
  if (const cut_cells* cut = space_->mesh().cut()) {
    open_faces_.assign(cut->faces().size(), of_others);
    walls_.assign(cut->walls().size(), of_others);
  }
  for (const budget_surface& one : space_->budget_surfaces()) {
    for (const int surface : one.surfaces) {
      const auto& of = space_->surfaces()[index(surface)];
      side& made = at(surface);
      for (const double v : equation.speeds(of.where.direction))
        made.inward.push_back(of.where.upper ? -v : v);
      const auto ends = index(of.own);
      made.values = field(static_cast<int>(ends), equation.components());
      const bool may_prescribe = space_->side(surface)->prescribes_incoming(0, 1);
      made.incoming = field(may_prescribe ? static_cast<int>(ends) : 0, equation.components());
      made.first = ends_;
      ends_ += ends;
    }
    for (const int number : one.cut_faces) open_faces_[index(number)] = ends_++;
    for (const int number : one.walls) walls_[index(number)] = ends_++;
  }
  // Fluxes from whole cells to cut cells stay in the gas.
  for (std::size_t k = 0; k < sides_.size(); ++k)
    if (space_->is_border_of_cut_cells(static_cast<int>(k)))
      sides_[k].values = field(space_->surfaces()[k].own, equation.components());
  rates_.resize(ends_ * invariants_);
  observed_.resize(ends_ * observed_moments * invariants_);
}

double* face_fluxes::recorded(int surface, int place) {
  return at(surface).values.row(place);
}

const double* face_fluxes::enter(int surface, int place, double t) {
  if (!prescribes(surface, place)) return nullptr;
  side& here = at(surface);
  const face where = space_->surfaces()[index(surface)].where;
  double *values = here.values.row(place), *incoming = here.incoming.row(place);
  const int width = equation_.components();
  face_rows::keep_leaving(here.inward.data(), width, values);
  space_->side(surface)->incoming_given_outgoing(where, t, space_->meeting_point(surface, place), values,
                                                 space_->ghost_rows(surface, place), incoming);
  face_rows::take_entering(here.inward.data(), incoming, width, values);
  return values;
}

void face_fluxes::account(int surface, int place) {
  side& here = at(surface);
  double* values = here.values.row(place);
  if (observes_) {
    continue_along(surface, place);
    observe_end(here.first + index(place), here.inward, values);
  }
  // The row becomes that of the fluxes, since invariants are linear functions of a row.
  face_rows::multiply(here.inward.data(), equation_.components(), values);
  double* received = rates_.data() + (here.first + index(place)) * invariants_;
  equation_.invariant_densities(values, received);
  const grid& mesh = space_->mesh();
  const double area = mesh.measure() * mesh.face_area(space_->surfaces()[index(surface)].where);
  for (std::size_t k = 0; k < invariants_; ++k) received[k] *= area;
}

void face_fluxes::complete(int surface, int place, double t, std::span<const target<field, double>> targets) {
  if (const double* values = enter(surface, place, t); values != nullptr) {
    const int cell = space_->cell_at(surface, place), width = equation_.components();
    const double spacing = space_->mesh().spacing(space_->surfaces()[index(surface)].where.direction);
    for (const auto& to : targets)
      face_rows::add_entering(inward(surface).data(), values, to.beta, spacing, width, to.acc->row(cell));
  }
  account(surface, place);
}

/// Sets the values of components along a face, which have no flux through it. If a boundary prescribes the
/// others, its ghost rows continue these components. The value at the face is the mean of both sides.
void face_fluxes::continue_along(int surface, int place) {
  side& here = at(surface);
  double* values = here.values.row(place);
  if (!prescribes(surface, place)) return;
  const double *cell = space_->row_at(surface, place), *ghost = space_->ghost_rows(surface, place)[0];
  for (std::size_t k = 0; k < here.inward.size(); ++k)
    if (here.inward[k] == 0.0) values[k] = 0.5 * (cell[k] + ghost[k]);
}

void face_fluxes::observe_end(std::size_t end, std::span<const double> inward, const double* values) {
  double* to = observed_.data() + end * observed_moments * invariants_;
  equation_.invariant_densities(values, to);
  std::vector<double> flux(inward.size());
  for (const double sign : {-1.0, 1.0}) {
    for (std::size_t k = 0; k < inward.size(); ++k) flux[k] = std::max(sign * inward[k], 0.0) * values[k];
    equation_.invariant_densities(flux.data(), to += invariants_);
  }
}

void face_fluxes::receive(std::size_t end, double area, std::span<const double> inward, const double* values,
                          double* flux) {
  if (end == of_others) return;
  if (observes_) observe_end(end, inward, values);
  std::copy_n(values, inward.size(), flux);
  face_rows::multiply(inward.data(), static_cast<int>(inward.size()), flux);
  double* received = rates_.data() + end * invariants_;
  equation_.invariant_densities(flux, received);
  for (std::size_t k = 0; k < invariants_; ++k) received[k] *= space_->mesh().measure() * area;
}

void face_fluxes::receive_through(int number, std::span<const double> inward, const double* values,
                                  double* flux) {
  receive(open_faces_[index(number)], space_->mesh().cut()->faces()[index(number)].area, inward, values,
          flux);
}

void face_fluxes::receive_at_wall(int number, std::span<const double> inward, const double* values,
                                  double* flux) {
  receive(walls_[index(number)], space_->mesh().cut()->walls()[index(number)].area, inward, values, flux);
}

void face_fluxes::set_inside(std::span<const double> inside) {
  rates_.resize(ends_ * invariants_ + inside.size());
  std::copy(inside.begin(), inside.end(), rates_.end() - static_cast<std::ptrdiff_t>(inside.size()));
}

}  // namespace apsis
