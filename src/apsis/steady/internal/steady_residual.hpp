#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/semidiscrete_problem.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/internal/cell_measures.hpp>

#include <vector>

namespace apsis {

/// The residual of a state, with moments and rates for an iteration. compute() is collective.
class steady_residual {
 public:
  /// Takes the moments and the rates of `start`; the residual is 0. `epsilon` are those of the cells. All
  /// references except `start` must outlive the object.
  steady_residual(const relaxation_model& equation, semidiscrete_problem& problem, const cell_links& links,
                  const cell_measures& cells, const std::vector<double>& epsilon, const field& start);

  /// r ← T(f) + Q(f)/ε, with the moments of f and of T(f), and the rates.
  void compute(const field& f);

  field r;                    ///< the iteration turns it into δf
  std::vector<double> omega,  ///< moments of f
      of_transport,           ///< moments of T(f)
      rates;                  ///< C/ε of the cells

 private:
  void find_rates();

  const relaxation_model& equation_;
  semidiscrete_problem& problem_;
  const cell_links& links_;
  const cell_measures& cells_;
  const std::vector<double>& epsilon_;
};

}  // namespace apsis
