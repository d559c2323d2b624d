#pragma once

#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/steady/mixture_rows.hpp>

#include <deque>
#include <vector>

namespace apsis {

/// Anderson's mixture g − Σ_j θ_j Δg_j of the images g = x + δ of a fixed-point iteration, with the θ that
/// minimize ‖r − Σ_j θ_j Δr_j‖₂ over the last differences. Source: Walker & Ni, SIAM J. Numer. Anal. 49,
/// 2011, with β = 1. An iteration calls weigh(), then move(). Nothing else may change x between two of them
/// but after clear(): the last image is not stored, it follows from x.
class anderson {
 public:
  /// The weights of the next mixture.
  struct weights {
    std::vector<double> theta;       ///< of the differences, the oldest one first
    std::vector<double> of_mixture;  ///< ℓ of the mixture
  };

  /// `depth`: differences that it remembers.
  explicit anderson(int depth) : depth_(depth) {}

  /// Returns the weights for the next image. `r`: any linear function of δ, always the same, on the root of
  /// the processes that share x. `of_image`: any linear functions ℓ of the image on this process. Collective.
  weights weigh(communicator& processes, std::vector<double> r, std::vector<double> of_image);
  /// x ← factor · mixture, and remembers the image; `of`: from weigh(), or without theta for the image
  /// itself.
  void move(const weights& of, const field& delta, double factor, field& x);
  /// Forgets all images.
  void clear();

 private:
  struct difference {
    field of_image;
    std::vector<double> of_r = {};  ///< on the root
    std::vector<double> of_functions = {};
  };

  mixture_rows::weighted_differences of_last_mixture() const;
  std::vector<double> shares(const std::vector<double>& r) const;

  int depth_;
  bool known_ = false;  ///< the last image g = x / factor + Σ_j θ_j Δg_j
  std::vector<double> last_theta_;
  double last_factor_ = 1.0;
  std::vector<double> last_r_, last_functions_;
  std::deque<difference> differences_;
  std::vector<field> spare_;  ///< memory of forgotten ones
};

/// x ← factor (x + share δ).
void move(const field& delta, double share, double factor, field& x);

}  // namespace apsis
