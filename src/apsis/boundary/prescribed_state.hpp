#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/model/data_form.hpp>

#include <span>
#include <string>
#include <vector>

namespace apsis {

/// Returns the form of data of a model that gives a Maxwellian by its density `rho`, bulk velocity `u` and
/// temperature `T`. Throws input_error with the name of the boundary if the model has no such form.
data_form maxwellian_form(const model& equation, const std::string& boundary_name);

/// A row at a face, given by the values of the variables of a form. It is computed only once if all values
/// are numbers. Thread-safe.
class prescribed_state {
 public:
  /// Throws input_error if all values are numbers and no row has them (T ≤ 0).
  prescribed_state(data_form form, std::vector<face_quantity> values, int components);

  /// Returns the row at time t at a point of the face. The row is in `buffer` of components() numbers unless
  /// it is constant. Throws input_error if no row has the values.
  const double* at(double t, const position& x, std::span<double> buffer) const;
  /// row ← the row with `numbers` as values of the variables, instead of those of the constructor. Throws as
  /// at() does; t and x are for the message.
  void write_other(std::span<const double> numbers, double t, const position& x, std::span<double> row) const;
  /// Does the same without an exception. Returns the reason why no row has the values, or "" if one has.
  std::string try_other(std::span<const double> numbers, std::span<double> row) const {
    return form_.row(numbers, row);
  }
  /// row ← the row at time t at a point of the face. Throws as at() does.
  void write(double t, const position& x, double* row) const;

 private:
  void compute(double t, const position& x, std::span<double> row) const;
  std::size_t index_of_problem(const std::string& problem) const;

  data_form form_;
  std::vector<face_quantity> values_;
  int components_;
  std::vector<double> constant_;
};

}  // namespace apsis
