#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace apsis {

/// A law of error control: it chooses the next step from the last three accepted ones. Estimated errors grow
/// like err ~ Δt^k. A step of length Δt_n with the error err_n could have been ℓ_n Δt_n long, where ℓ_n = 0.9
/// (tol/err_n)^{1/k}. After an accepted step
///   Δt_{n+1} = Δt_n ℓ_n^{β₁} ℓ_{n−1}^{β₂} ℓ_{n−2}^{β₃} (Δt_n/Δt_{n−1})^{−α},
/// a digital filter of the errors (G. Söderlind, ACM Trans. Math. Softw. 29 (2003) 1–26). At the beginning, ℓ
/// and quotients of missing steps are 1. The predictive law is Δt_{n+1} = ℓ_n Δt_n min(1, ℓ_n Δt_n/(ℓ_{n−1}
/// Δt_{n−1})). Every law settles where ℓ = 1.
struct step_law {
  std::string name,              ///< of time.controller
      title,                     ///< its use, for lists
      citation;                  ///< where it was published
  std::array<double, 3> beta{};  ///< β₁, β₂, β₃
  double alpha = 0.0;            ///< α
  bool predictive = false;       ///< the predictive law, without β and α
};

/// Name of the default law.
inline constexpr std::string_view usual_step_law = "predictive";

/// Returns all laws.
const std::vector<step_law>& step_laws();

/// Returns the names of all laws.
std::vector<std::string> step_law_names();

/// Returns the law of this name. Throws input_error with the nearest name.
const step_law& find_step_law(const std::string& name);

}  // namespace apsis
