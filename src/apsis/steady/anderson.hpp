#pragma once

#include <apsis/exec/communicator.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/steady/mixture_rows.hpp>

#include <deque>
#include <vector>

namespace apsis {

/// Anderson's mixture g − Σ_j θ_j Δg_j of the images g = x + δ of a fixed-point iteration. The weights θ
/// minimize ‖r − Σ_j θ_j Δr_j‖₂ over the last differences. Source: Walker & Ni, SIAM J. Numer. Anal. 49,
/// 2011, with β = 1. An iteration calls weigh(), then move(). The last image is not stored, because it
/// follows from x. Nothing else may therefore change x, unless clear() follows.
class anderson {
 public:
  /// The weights of the next mixture.
  struct weights {
    std::vector<double> theta;       ///< weights of the differences, the oldest one first
    std::vector<double> of_mixture;  ///< ℓ of the mixture
  };

  /// `depth` is the number of differences that are stored.
  explicit anderson(int depth) : depth_(depth) {}

  /// Returns the weights for the next image. `r` is any linear function of δ, always the same one, on
  /// the root of the processes that share x. `of_image` are any linear functions ℓ of the image on
  /// this process. Collective.
  weights weigh(communicator& processes, std::vector<double> r, std::vector<double> of_image);
  /// x ← factor · mixture; also stores the image. `of` comes from weigh(), or has no theta for
  /// the image itself.
  void move(const weights& of, const field& delta, double factor, field& x);
  /// Discards all images.
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
  bool known_ = false;  ///< whether the last image is known: g = x / factor + Σ_j θ_j Δg_j
  std::vector<double> last_theta_;
  double last_factor_ = 1.0;
  std::vector<double> last_r_, last_functions_;
  std::deque<difference> differences_;
  std::vector<field> spare_;  ///< memory of discarded images
};

/// x ← factor (x + share δ).
void move(const field& delta, double share, double factor, field& x);

}  // namespace apsis
