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
/// of the transport record the upwind values at a surface. If a boundary prescribes the incoming components,
/// they are computed here from the outgoing ones after the sweep. The sweep assumes a vacuum beyond such a
/// surface. The incoming flux is therefore added to a state that is nonnegative without it. The fluxes of the
/// invariants at all ends are the rates of a boundary_budget.
class face_fluxes {
 public:
  /// `equation` must outlive the object.
  face_fluxes(const model& equation, std::shared_ptr<domain> space);

  /// Returns true if the boundary prescribes the components that enter at an end of a segment.
  bool prescribes(int surface, int place) const { return space_->prescribes_incoming(surface, place); }
  /// Returns the row for the upwind values at an end of a segment. Only outgoing components need values if
  /// the boundary prescribes the others.
  double* recorded(int surface, int place);

  /// Completes an end of a segment after all of its components are recorded: adds incoming fluxes to the
  /// targets. Concurrent calls must differ in the cell at the end.
  void complete(int surface, int place, double t, std::span<const target<field, double>> targets);
  /// The first part of complete(): returns the upwind values, including the entering ones if the boundary
  /// prescribes them. Returns null for other boundaries. Concurrent calls must differ in the end.
  const double* enter(int surface, int place, double t);
  /// The last part of complete(): computes the rates of an end.
  void account(int surface, int place);
  /// Returns v·n of every component at a surface, with the normal n into the gas.
  std::span<const double> inward(int surface) const {
    return sides_[static_cast<std::size_t>(surface)].inward;
  }

  /// Receives the values at an open face of a cut cell, by the number of the face in cut_cells. The face is a
  /// face of the domain. `inward` is v·n of every component with n into the gas, and `flux` is scratch memory
  /// of one row. Has no effect in cells of other processes.
  void receive_through(int open_face, std::span<const double> inward, const double* values, double* flux);
  /// Does the same at a wall segment, by its number in cut_cells.
  void receive_at_wall(int wall, std::span<const double> inward, const double* values, double* flux);

  /// Number of observed moments of each invariant: its density, the arriving and the leaving flux.
  static constexpr std::size_t observed_moments = 3;
  /// Sets whether complete() and the other members also compute moments of the distribution at the surfaces.
  void observe(bool wanted) { observes_ = wanted; }
  /// Returns the observed moments of the last evaluation, [end][moment][invariant], with the ends in the
  /// order of a boundary_budget. They are, per area, those of the distribution f at the face with the normal
  /// n into the gas:
  ///     density ∫ψ f dv,  arriving ∫_{v·n<0} |v·n| ψ f dv,  leaving ∫_{v·n>0} v·n ψ f dv.
  const std::vector<double>& observed() const { return observed_; }

  /// Stores the rates of a force, of the rotation of axisymmetric flow, and of a source, after the rates
  /// of all ends.
  void set_inside(std::span<const double> inside);
  /// Returns the amounts received per unit of time, in the layout of a boundary_budget. They are those of the
  /// last complete() of every end and of the last set_inside().
  std::span<const double> rates() const { return rates_; }

 private:
  struct side {
    std::vector<double> inward;  ///< velocity towards the inside of every component
    field values;                ///< [place], recorded upwind values
    field incoming;              ///< [place], values that the boundary prescribes
    std::size_t first = 0;       ///< first of its ends among those of all budget surfaces
  };
  side& at(int surface) { return sides_[static_cast<std::size_t>(surface)]; }
  void continue_along(int surface, int place);
  void observe_end(std::size_t end, std::span<const double> inward, const double* values);
  void receive(std::size_t end, double area, std::span<const double> inward, const double* values,
               double* flux);

  const model& equation_;
  std::shared_ptr<domain> space_;
  std::vector<side> sides_;                      ///< [surface]
  std::vector<std::size_t> open_faces_, walls_;  ///< their ends, by number in cut_cells
  std::size_t invariants_ = 0;
  std::size_t ends_ = 0;       ///< number of ends of all budget surfaces
  std::vector<double> rates_;  ///< amounts received per unit of time, in the layout of a boundary_budget
  bool observes_ = false;
  std::vector<double> observed_;
};

}  // namespace apsis
