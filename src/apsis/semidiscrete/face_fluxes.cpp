#include <apsis/semidiscrete/face_fluxes.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace apsis {
namespace {

std::size_t index(int k) {
  return static_cast<std::size_t>(k);
}

}  // namespace

face_fluxes::face_fluxes(const model& equation, std::shared_ptr<domain> space)
    : equation_(equation), space_(std::move(space)), invariants_(equation.invariants().size()) {
  sides_.resize(space_->surfaces().size());
  for (const opening& one : space_->openings())
    for (const int surface : one.surfaces) {
      const auto& of = space_->surfaces()[index(surface)];
      side& made = at(surface);
      for (const double v : equation.speeds(of.where.direction))
        made.inward.push_back(of.where.upper ? -v : v);
      const auto ends = of.segments.size();
      made.values = field(static_cast<int>(ends), equation.components());
      made.incoming = field(prescribes(surface) ? static_cast<int>(ends) : 0, equation.components());
      made.received.assign(ends, std::vector<double>(invariants_));
    }
}

double* face_fluxes::recorded(int surface, int place) {
  return at(surface).values.row(place);
}

void face_fluxes::complete(int surface, int place, double t, std::span<const target<field, double>> targets) {
  side& here = at(surface);
  const grid& mesh = space_->mesh();
  const face where = space_->surfaces()[index(surface)].where;
  double* values = here.values.row(place);
  if (prescribes(surface)) {
    for (std::size_t k = 0; k < here.inward.size(); ++k)
      if (!(here.inward[k] < 0.0)) values[k] = 0.0;
    double* incoming = here.incoming.row(place);
    thread_local std::vector<const double*> ghosts;
    space_->ghost_rows(surface, place, ghosts);
    space_->side(surface)->incoming_beside(where, t, space_->meeting_point(surface, place), values, ghosts,
                                           incoming);
    const int cell = space_->cell_at(surface, place);
    for (std::size_t k = 0; k < here.inward.size(); ++k)
      if (here.inward[k] > 0.0) values[k] = incoming[k];
    for (const auto& to : targets) {
      double* acc = to.acc->row(cell);
      for (std::size_t k = 0; k < here.inward.size(); ++k)
        if (here.inward[k] > 0.0)
          acc[k] += (to.beta * (here.inward[k] / mesh.spacing(where.direction))) * values[k];
    }
  }
  // The row becomes that of the fluxes; invariants are linear functions of a row.
  for (std::size_t k = 0; k < here.inward.size(); ++k) values[k] *= here.inward[k];
  std::vector<double>& received = here.received[index(place)];
  equation_.invariant_densities(values, received.data());
  const double area = mesh.cell_volume() / mesh.spacing(where.direction);
  for (double& one : received) one *= area;
}

void face_fluxes::add_gains(const field& u, std::span<const target<field, double>> targets, bool moved,
                            std::span<const double> inside) const {
  if ((space_->openings().empty() && inside.empty()) || !moved) return combine_gains(u, targets);
  std::vector<double> rates;
  for (const opening& one : space_->openings()) {
    std::vector<double> sum(invariants_);
    for (const int surface : one.surfaces)
      for (const auto& received : sides_[index(surface)].received)
        for (std::size_t k = 0; k < invariants_; ++k) sum[k] += received[k];
    rates.insert(rates.end(), sum.begin(), sum.end());
  }
  rates.insert(rates.end(), inside.begin(), inside.end());
  for (const auto& to : targets) {
    std::vector<double>& gains = to.acc->gains();
    gains.resize(rates.size());
    for (std::size_t k = 0; k < rates.size(); ++k)
      gains[k] = to.combine(gains[k], u.gains().empty() ? 0.0 : u.gains()[k], rates[k]);
  }
}

void combine_gains(const field& u, std::span<const target<field, double>> targets) {
  // A copy: an accumulator may be u itself.
  const std::vector<double> of_u = u.gains();  // NOLINT(performance-unnecessary-copy-initialization)
  for (const auto& to : targets) {
    std::vector<double>& gains = to.acc->gains();
    if (to.fresh) gains.clear();
    gains.resize(std::max(gains.size(), of_u.size()));
    for (std::size_t k = 0; k < of_u.size(); ++k) gains[k] += to.alpha * of_u[k];
  }
}

}  // namespace apsis
