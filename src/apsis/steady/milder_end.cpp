#include <apsis/boundary/oblique_wall.hpp>
#include <apsis/core/index.hpp>
#include <apsis/steady/milder_ends.hpp>

#include <utility>

namespace apsis {
namespace {

using shared_row = std::shared_ptr<const std::vector<double>>;

/// values ← s values + (1 − s) c M, where c M has the mass flux of `values`. flux(j) is the mass flux of
/// component j into the gas per density. Components that leave do not count.
template <class Flux>
void mix(double share, const std::vector<double>& row, std::size_t velocities, const Flux& flux,
         double* values) {
  double entering = 0.0, of_row = 0.0;
  for (std::size_t j = 0; j < velocities; ++j) {
    const double one = flux(j);
    if (!(one > 0.0)) continue;
    entering += one * values[j];
    of_row += one * row[j];
  }
  if (!(entering > 0.0) || !(of_row > 0.0)) return;
  const double factor = (1.0 - share) * (entering / of_row);
  for (std::size_t k = 0; k < row.size(); ++k) values[k] = share * values[k] + factor * row[k];
}

/// A mixed boundary condition at a wall with any normal.
class mixed_wall final : public oblique_wall {
 public:
  mixed_wall(std::shared_ptr<const oblique_wall> of, double share, shared_row row,
             const velocity_set& velocities)
      : of_(std::move(of)),
        share_(share),
        row_(std::move(row)),
        weights_(velocities.weights().begin(), velocities.weights().end()) {}

  std::array<double, 3> velocity(const wall_point& where) const override { return of_->velocity(where); }

  void emit(const wall_point& where, const double* inward, const double* arriving,
            double* values) const override {
    of_->emit(where, inward, arriving, values);
    mix(share_, *row_, weights_.size(), [&](std::size_t j) { return weights_[j] * inward[j]; }, values);
  }

 private:
  std::shared_ptr<const oblique_wall> of_;
  double share_;
  shared_row row_;
  std::vector<double> weights_;
};

class mixed_end final : public boundary {
 public:
  mixed_end(std::shared_ptr<const boundary> of, double share, shared_row row)
      : of_(std::move(of)), share_(share), row_(std::move(row)) {}

  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    auto own = std::make_shared<mixed_end>(*this);
    if (auto tables = of_->prepared(where, velocities)) own->of_ = std::move(tables);
    own->mass_flux_ = inward_speeds(where, velocities);
    own->mass_flux_.resize(velocities.weights().size());
    for (std::size_t j = 0; j < own->mass_flux_.size(); ++j) own->mass_flux_[j] *= velocities.weights()[j];
    return own;
  }

  std::shared_ptr<const boundary> on_surface(const std::function<double()>& area) const override {
    auto side = of_->on_surface(area);
    if (!side) return nullptr;
    auto own = std::make_shared<mixed_end>(*this);
    own->of_ = std::move(side);
    return own;
  }

  std::shared_ptr<const oblique_wall> oblique(const velocity_set& velocities) const override {
    auto wall = of_->oblique(velocities);
    return wall ? std::make_shared<mixed_wall>(std::move(wall), share_, row_, velocities) : nullptr;
  }

  std::optional<int> cell_of_ghost(int ghost, int cells) const override {
    return of_->cell_of_ghost(ghost, cells);
  }
  void fill(const face& where, double t, const pencil_end& rows) const override { of_->fill(where, t, rows); }
  bool prescribes_incoming(int cells, int ghosts) const override {
    return of_->prescribes_incoming(cells, ghosts);
  }
  void incoming(const face& where, double t, const position& at, const double* outgoing,
                double* values) const override {
    of_->incoming(where, t, at, outgoing, values);
    add_start(values);
  }
  void incoming_given_outgoing(const face& where, double t, const position& at, const double* outgoing,
                               std::span<const double* const> ghosts, double* values) const override {
    of_->incoming_given_outgoing(where, t, at, outgoing, ghosts, values);
    add_start(values);
  }
  std::array<double, 3> wall_velocity(double t, const position& at) const override {
    return of_->wall_velocity(t, at);
  }
  const boundary& undecorated() const override { return of_->undecorated(); }
  bool periodic() const override { return of_->periodic(); }

 private:
  void add_start(double* values) const {
    mix(share_, *row_, mass_flux_.size(), [&](std::size_t j) { return mass_flux_[j]; }, values);
  }

  std::shared_ptr<const boundary> of_;
  double share_;
  shared_row row_;
  std::vector<double> mass_flux_;  ///< fluxes of unit components of the first set; > 0 enters
};

}  // namespace

std::shared_ptr<const boundary> milder_end(std::shared_ptr<const boundary> of, double share,
                                           std::shared_ptr<const std::vector<double>> row) {
  return std::make_shared<mixed_end>(std::move(of), share, std::move(row));
}

}  // namespace apsis
