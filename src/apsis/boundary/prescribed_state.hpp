#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/model/data_form.hpp>

#include <span>
#include <string>
#include <vector>

namespace apsis {

/// Returns the Maxwellian of density `rho`, bulk velocity `u` and temperature `T` as a form of data of a
/// model. Throws input_error with the name of the boundary that needs it if the model has none.
data_form maxwellian_form(const model& equation, const std::string& boundary_name);

/// A row at a face by the values of the variables of a form; computed once if all of them are numbers.
/// Thread-safe.
class prescribed_state {
 public:
  /// Throws input_error if the values are numbers and no row has them (T ≤ 0).
  prescribed_state(data_form form, std::vector<face_quantity> values, int components);

  /// Returns the row at time t at a point of the face, in `buffer` of components() numbers unless it is
  /// constant. Throws input_error if no row has the values.
  const double* at(double t, const position& x, std::span<double> buffer) const;
  /// row ← the row with these values of the variables in place of those that it was made with. Throws as at()
  /// does; t and x are for the message.
  void write_other(std::span<const double> numbers, double t, const position& x, std::span<double> row) const;
  /// The same; returns why no row has the values, "" if one has.
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
