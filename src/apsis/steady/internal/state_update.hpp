#pragma once

#include <apsis/mesh/field.hpp>
#include <apsis/semidiscrete/problem_builder.hpp>
#include <apsis/steady/anderson.hpp>
#include <apsis/steady/internal/cell_measures.hpp>

#include <optional>
#include <vector>

namespace apsis {

/// Changes a state by δf, mixed with earlier images. Members are collective.
class state_update {
 public:
  /// `start` are the moments of the first state; their scales weight the moments in the mixture. `depth` is
  /// the number of images in the mixture. All references except `start` must outlive the object.
  state_update(const problem_builder& space, const cell_measures& cells, const std::vector<double>& start,
               int depth);

  /// Options of apply().
  struct plan {
    bool mixes;                        ///< whether to mix with earlier images
    std::optional<double> total_mass;  ///< mass that f gets; nothing if mass may enter
  };
  /// f ← f + δ, or the mixture. If the temperature of a cell falls too much, δ is reduced, or the image
  /// replaces the mixture. `omega` are the moments of f.
  void apply(const plan& how, const std::vector<double>& omega, const field& delta, field& f);
  /// Discards earlier images.
  void clear() { mixture_.clear(); }

 private:
  const problem_builder& space_;
  const cell_measures& cells_;
  std::vector<double> scales_;
  anderson mixture_;
};

}  // namespace apsis
