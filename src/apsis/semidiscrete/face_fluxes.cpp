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
  const grid& mesh = space_->mesh();
  if (equation.space_dimensions() == 0) return;
  sides_.resize(index(mesh.dimensions()));
  for (int direction = 0; direction < mesh.dimensions(); ++direction)
    for (const bool upper : {false, true}) {
      const face where{direction, upper};
      if (!records(where)) continue;
      open_ = true;
      side& made = at(where);
      for (const double v : equation.speeds(direction)) made.inward.push_back(upper ? -v : v);
      made.values = field(mesh.pencils(direction), equation.components());
      made.incoming = field(prescribes(where) ? mesh.pencils(direction) : 0, equation.components());
      made.received.assign(index(mesh.pencils(direction)), std::vector<double>(invariants_));
    }
}

face_fluxes::side& face_fluxes::at(const face& where) {
  return sides_[index(where.direction)][where.upper ? 1 : 0];
}

double* face_fluxes::recorded(const face& where, int pencil) {
  return at(where).values.row(pencil);
}

void face_fluxes::complete(const face& where, int pencil, double t,
                           std::span<const target<field, double>> targets) {
  side& here = at(where);
  const grid& mesh = space_->mesh();
  double* values = here.values.row(pencil);
  if (prescribes(where)) {
    for (std::size_t k = 0; k < here.inward.size(); ++k)
      if (!(here.inward[k] < 0.0)) values[k] = 0.0;
    double* incoming = here.incoming.row(pencil);
    thread_local std::vector<const double*> ghosts;
    space_->ghost_rows(where, pencil, ghosts);
    space_->side(where).incoming_beside(where, t, space_->meeting_point(where, pencil), values, ghosts,
                                        incoming);
    const int last = mesh.cells(where.direction) - 1;
    const int cell =
        mesh.first_cell(where.direction, pencil) + (where.upper ? last : 0) * mesh.stride(where.direction);
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
  std::vector<double>& received = here.received[index(pencil)];
  equation_.invariant_densities(values, received.data());
  const double area = mesh.cell_volume() / mesh.spacing(where.direction);
  for (double& one : received) one *= area;
}

void face_fluxes::add_gains(const field& u, std::span<const target<field, double>> targets, bool moved,
                            std::span<const double> inside) const {
  if ((!open_ && inside.empty()) || !moved) return combine_gains(u, targets);
  std::vector<double> rates;
  for (const auto& pair : sides_)
    for (const side& one : pair) {
      if (one.received.empty()) continue;  // periodic
      std::vector<double> sum(invariants_);
      for (const auto& received : one.received)
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
