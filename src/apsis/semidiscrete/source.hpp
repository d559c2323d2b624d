#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/model/source_rate.hpp>
#include <apsis/semidiscrete/cell_unknown.hpp>

#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// A source S(t, x, u) as a part of T. A quadrature over the cell evaluates it: at the centre for point
/// values, or at three Gauss points for averages. At Gauss points u is the average, so that a source that
/// depends on u is of second order. If the unknowns are nonnegative, so is S, and it does not limit Δt_FE: a
/// forward Euler step that preserves u ≥ 0 preserves u + Δt S ≥ 0. Dimensionless.
class source {
 public:
  /// `equation` must outlive the object.
  source(const model& equation, std::shared_ptr<domain> space, source_rate rate, const cell_unknown& unknown);

  /// Computes values(), unless S does not change in time and is known. Returns true if they are new. Throws
  /// numerical_error if S is not finite, or negative although the unknowns of the model are not. Collective.
  bool update(double t, const field& u);
  /// acc ← acc + β values() in the cells begin … end−1 for every target, by any thread.
  void add(std::span<const target<field, double>> targets, int begin, int end) const;
  /// Returns S of the last update().
  const field& values() const { return values_; }
  /// Returns true if S depends on u.
  bool depends_on_state() const { return static_cast<bool>(rate_.growth); }
  /// Returns the largest source_rate::growth of the cells of this process.
  double growth(double t, const field& u) const;
  /// Returns the amounts of the invariants that values() give per unit of time and β.
  const std::vector<double>& given() const { return given_; }

 private:
  void compute(double t, const field& u);
  void compute_cell(double t, int cell, const field& u, std::vector<double>& row);

  const model& equation_;
  std::shared_ptr<domain> space_;
  source_rate rate_;
  std::span<const weighted_point> points_;
  bool known_ = false;
  field values_;
  std::vector<double> given_;
};

}  // namespace apsis
