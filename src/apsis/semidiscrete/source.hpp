#pragma once

#include <apsis/integrate/problem.hpp>
#include <apsis/model/model.hpp>
#include <apsis/phase/domain.hpp>
#include <apsis/phase/field.hpp>
#include <apsis/phase/source_rate.hpp>
#include <apsis/scheme/formulation.hpp>

#include <memory>
#include <span>
#include <vector>

namespace apsis {

/// A source S(t, x) ≥ 0 as a part of T: point values at the centres of cells, or averages by three Gauss
/// points. It does not limit Δt_FE: a forward Euler step that keeps u ≥ 0 keeps u + Δt S ≥ 0. Dimensionless.
class source {
 public:
  /// `equation` must outlive the object.
  source(const model& equation, std::shared_ptr<domain> space, source_rate rate, formulation unknowns);

  /// acc ← acc + β S(t) for every target. Throws numerical_error where S is not finite, or negative in a
  /// model whose unknowns are not.
  void add(double t, std::span<const target<field, double>> targets);
  /// Returns the invariants that the last add() gave per unit of time and β.
  const std::vector<double>& given() const { return given_; }

 private:
  void compute(double t);
  void compute_cell(double t, int cell, std::vector<double>& row);

  const model& equation_;
  std::shared_ptr<domain> space_;
  source_rate rate_;
  bool averages_, known_ = false;
  field values_;
  std::vector<double> given_;
};

}  // namespace apsis
