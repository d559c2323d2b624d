#pragma once

#include <apsis/integrate/problem.hpp>
#include <apsis/model/model.hpp>
#include <apsis/phase/domain.hpp>
#include <apsis/phase/field.hpp>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// Fluxes through the faces of a domain that are not periodic. Sweeps of the transport record the upwind
/// values at a face; where the boundary prescribes the incoming components, it computes them here from the
/// outgoing ones, after the sweep: beyond such a face a sweep sees vacuum, so that what enters is added to a
/// state that is nonnegative without it. The invariants that pass are collected in field::gains().
class face_fluxes {
 public:
  /// `equation` must outlive the object.
  face_fluxes(const model& equation, std::shared_ptr<domain> space);

  /// Whether the fluxes through a face are recorded.
  bool records(const face& where) const { return !space_->periodic(where.direction); }
  /// Whether the boundary prescribes the incoming components.
  bool prescribes(const face& where) const { return space_->side(where).prescribes_incoming(); }
  /// Returns the row that takes the upwind values at a face, of outgoing components alone if the boundary
  /// prescribes the others.
  double* recorded(const face& where, int pencil);

  /// Completes a pencil at a face whose components are all recorded: incoming fluxes are added to the
  /// targets. Concurrent calls must differ in pencil or face.
  void complete(const face& where, int pencil, double t, std::span<const target<field, double>> targets);

  /// acc ← (fresh ? 0 : acc) + α u + β (flux) for the gains of every target; with `moved`, the fluxes are
  /// those of complete(), else 0. `inside` is what a force and a source give, after all faces.
  void add_gains(const field& u, std::span<const target<field, double>> targets, bool moved,
                 std::span<const double> inside = {}) const;

 private:
  struct side {
    std::vector<double> inward;                 ///< velocity towards the inside of every component
    field values;                               ///< [pencil], recorded upwind values
    field incoming;                             ///< [pencil], what the boundary prescribes
    std::vector<std::vector<double>> received;  ///< [pencil][invariant], per unit of time
  };
  side& at(const face& where);

  const model& equation_;
  std::shared_ptr<domain> space_;
  std::vector<std::array<side, 2>> sides_;  ///< [direction][upper]
  std::size_t invariants_ = 0;
  bool open_ = false;  ///< whether any face is recorded
};

/// The part of add_gains() without fluxes, for operations that conserve the invariants.
void combine_gains(const field& u, std::span<const target<field, double>> targets);

}  // namespace apsis
