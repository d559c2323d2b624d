#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>

#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// Fluxes through the surfaces of a domain: its faces that are not periodic, and those of solid boxes. Sweeps
/// of the transport record the upwind values at a surface. A boundary that prescribes the incoming components
/// computes them here from the outgoing ones, after the sweep. The sweep assumes vacuum beyond such a
/// surface, so that the incoming flux is added to a state that is nonnegative without it. The fluxes of the
/// invariants at all ends are the rates of a boundary_budget.
class face_fluxes {
 public:
  /// `equation` must outlive the object.
  face_fluxes(const model& equation, std::shared_ptr<domain> space);

  /// Whether the boundary prescribes the components that enter at an end of a segment.
  bool prescribes(int surface, int place) const { return space_->prescribes_incoming(surface, place); }
  /// Returns the row that takes the upwind values at an end of a segment, of outgoing components alone if the
  /// boundary prescribes the others.
  double* recorded(int surface, int place);

  /// Completes an end of a segment whose components are all recorded: incoming fluxes are added to the
  /// targets. Concurrent calls must differ in the cell at the end.
  void complete(int surface, int place, double t, std::span<const target<field, double>> targets);
  /// The first part of complete(): returns the upwind values with those that enter, of a boundary that
  /// prescribes them; null for other boundaries. Concurrent calls must differ in the end.
  const double* enter(int surface, int place, double t);
  /// The last part: the rates of an end.
  void account(int surface, int place);
  /// Returns v·n of every component at a surface, n into the gas.
  std::span<const double> inward(int surface) const {
    return sides_[static_cast<std::size_t>(surface)].inward;
  }

  /// Takes the values at an open face of a cut cell at a face of the domain, or at a wall segment, by its
  /// number in cut_cells; without effect in cells of other processes. `inward`: v·n of every component, n
  /// into the gas; `flux`: scratch of one row.
  void receive_through(int open_face, std::span<const double> inward, const double* values, double* flux);
  /// The same at a wall.
  void receive_at_wall(int wall, std::span<const double> inward, const double* values, double* flux);

  /// Number of moments of each invariant that are observed: its density, the arriving and the leaving flux.
  static constexpr std::size_t observed_moments = 3;
  /// Whether complete() and the other members also compute the moments of the distribution at the surfaces.
  void observe(bool wanted) { observes_ = wanted; }
  /// Returns those of the last evaluation, [end][moment][invariant] with the ends in the order of a
  /// boundary_budget, of the distribution f at the face:
  ///     density ∫ψ f dv,  arriving ∫_{v·n<0} |v·n| ψ f dv,  leaving ∫_{v·n>0} v·n ψ f dv,
  /// n being the normal into the gas: per area, that arrives at the surface and that leaves it.
  const std::vector<double>& observed() const { return observed_; }

  /// Stores the rates of a force, of the rotation of axisymmetric flow and of a source, after the rates of
  /// all ends.
  void set_inside(std::span<const double> inside);
  /// Returns what is received per unit of time, in the layout of a boundary_budget: by the last complete() of
  /// every end, and by the last set_inside().
  std::span<const double> rates() const { return rates_; }

 private:
  struct side {
    std::vector<double> inward;  ///< velocity towards the inside of every component
    field values;                ///< [place], recorded upwind values
    field incoming;              ///< [place], what the boundary prescribes
    std::size_t first = 0;       ///< of its ends among those of all budget surfaces
  };
  side& at(int surface) { return sides_[static_cast<std::size_t>(surface)]; }
  void continue_along(int surface, int place);
  void observe_end(std::size_t end, std::span<const double> inward, const double* values);
  void receive(std::size_t end, double area, std::span<const double> inward, const double* values,
               double* flux);

  const model& equation_;
  std::shared_ptr<domain> space_;
  std::vector<side> sides_;                      ///< [surface]
  std::vector<std::size_t> open_faces_, walls_;  ///< their ends, by their numbers in cut_cells
  std::size_t invariants_ = 0;
  std::size_t ends_ = 0;       ///< of all budget surfaces
  std::vector<double> rates_;  ///< what is received per unit of time, in the layout of a boundary_budget
  bool observes_ = false;
  std::vector<double> observed_;
};

}  // namespace apsis
