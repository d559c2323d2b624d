#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/steady/anderson.hpp>
#include <apsis/steady/internal/cell_measures.hpp>

#include <optional>
#include <vector>

namespace apsis {

/// Moves a state by δf, mixed with earlier images. Members are collective.
class state_update {
 public:
  /// `start`: moments of the first state, whose scales compare moments with each other; `depth`: images that
  /// the mixture remembers. All references but `start` must outlive the object.
  state_update(const problem_builder& space, const cell_measures& cells, const std::vector<double>& start,
               int depth);

  /// How apply() moves the state.
  struct plan {
    bool mixes;                        ///< whether earlier images count
    std::optional<double> total_mass;  ///< that f gets; nothing where mass may enter
  };
  /// f ← f + δ. Less of δ where it leaves too little temperature, and the image itself where the mixture
  /// does. `omega`: the moments of f.
  void apply(const plan& how, const std::vector<double>& omega, const field& delta, field& f);
  /// Forgets earlier images.
  void clear() { mixture_.clear(); }

 private:
  const problem_builder& space_;
  const cell_measures& cells_;
  std::vector<double> scales_;
  anderson mixture_;
};

}  // namespace apsis
