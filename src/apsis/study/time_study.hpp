#pragma once

#include <apsis/config/case.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/method/method.hpp>
#include <apsis/study/study_control.hpp>

#include <memory>
#include <string>
#include <vector>

namespace apsis {

/// Initial data of a time study.
enum class start_data {
  given,       ///< those of the case
  equilibrium  ///< their local equilibrium E(ℛu), consistent up to O(ε)
};
/// The first step of a time study.
enum class first_step {
  plain,    ///< as long as the others
  resolved  ///< divided into steps that resolve the initial layer (graded_start)
};

/// Temporal accuracy of methods on a case with a relaxation model. On its mesh, the case is a system of
/// ordinary differential equations; extrapolate() computes the exact solution of this system. Space is
/// discretised once and does not affect the error. ε is constant and given here; the ε, method and step of
/// the case are not used.
class time_study {
 public:
  /// Throws input_error unless the model is a relaxation model, and the errors of run_setup.
  time_study(const case_config& config, double epsilon);
  ~time_study();
  time_study(time_study&&) noexcept;  ///< leaves the source empty

  /// Returns the initial state, which always has point values.
  field start(start_data data) const;
  /// Returns the solution at the end time with `steps` equal steps.
  field solve(const method& m, long steps, start_data data = start_data::given,
              first_step first = first_step::plain, const study_control& control = {}) const;
  /// Returns the exact solution of the discretised system up to about 100 · tolerance.
  field reference(start_data data = start_data::given, double tolerance = 1e-11,
                  const study_control& control = {}) const;

  /// Returns time.end of the case.
  double end() const;
  /// Returns ω = ℛu of all cells.
  std::vector<double> moments(const field& u) const;
  /// Returns E(ℛu) − u of all cells, component by component.
  std::vector<double> deviation(const field& u) const;

 private:
  struct impl;
  std::unique_ptr<impl> impl_;
};

/// Returns the largest difference of two states.
double largest_difference(const field& u, const field& v);

}  // namespace apsis
