#pragma once

#include <apsis/model/central_sums.hpp>
#include <apsis/model/gas_target.hpp>
#include <apsis/model/line_moments.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace apsis {

/// Relative size of a defect that counts as rounding.
inline constexpr double target_rounding = 4.5e-16;

/// The differences of moments about the bulk velocity, each relative to its scale.
struct target_defect {
  double mass = 0.0, energy = 0.0;
  std::array<double, 3> momentum{};

  double size() const { return std::max({std::abs(mass), std::abs(energy), largest_momentum()}); }
  double largest_momentum() const {
    return std::max({std::abs(momentum[0]), std::abs(momentum[1]), std::abs(momentum[2])});
  }
};

/// The polynomial α + β·c + γ|c|².
struct target_correction {
  double k;                   ///< α
  std::array<double, 3> l{};  ///< β
  double a;                   ///< γ

  void add_to(target_polynomial& p, int d) const {
    p.k += k;
    for (std::size_t i = 0; i < static_cast<std::size_t>(d); ++i) {
      p.l[i] += l[i];
      p.a[i][i] += a;
    }
  }
};

/// Returns what takes a defect away, with the moments of a Gaussian of this variance in d directions.
target_correction correction_of(const target_defect& found, int d, double variance);

/// Moments of polynomials times a product of lines, with which the moments of a target are restored without a
/// pass over its row.
class moments_of_product {
 public:
  moments_of_product(const line_moments& lines, int dimensions);

  /// Corrects the shape so that the moments of the target are those of its base. Returns false where that
  /// does not contract.
  bool correct(target_shape& shape) const;

 private:
  using powers = std::array<std::size_t, 3>;
  template <std::size_t D>
  bool correct_in(target_shape& shape) const;
  template <std::size_t D>
  double mean(const powers& p) const;
  template <std::size_t D>
  double mean(const target_polynomial& polynomial, const powers& p) const;
  template <std::size_t D>
  target_defect defect_of(const target_shape& shape) const;
  void add(const target_correction& by, double variance, target_defect& found) const;

  const line_moments& lines_;
  std::size_t d_;
  double square_ = 0.0, fourth_ = 0.0;  // ⟨|c|²⟩, ⟨|c|⁴⟩
  std::array<double, 3> of_square_{};   // ⟨c_k |c|²⟩
};

/// Moments of a base (g, θ g) and of its target.
struct base_contents {
  double rho,  ///< density ρ
      others,  ///< θ
      energy;  ///< Σ (|c|² e_g + e_h)/ρ, twice the internal energy of the target per density
};

/// Moments of polynomials of degree 2 times a row g of any form, by its central moments up to degree 4.
class moments_of_row {
 public:
  moments_of_row(const central_sums& sums, int dimensions, const base_contents& contents)
      : sums_(sums), d_(static_cast<std::size_t>(dimensions)), contents_(contents) {}

  /// Corrects the shape so that the target has the density and energy of the contents, and no momentum.
  /// Returns false where rounding does not let it.
  bool correct(target_shape& shape) const;

 private:
  template <int size>
  bool correct_by(target_shape& shape) const;
  template <int size>
  target_correction correction_of_row(const target_defect& found, double variance) const;
  /// ⟨P Π c_k^p_k⟩.
  template <std::size_t D>
  double mean(const target_polynomial& polynomial, const central_sums::exponents& p) const;
  template <std::size_t D>
  target_defect defect_of(const target_shape& shape) const;

  const central_sums& sums_;
  std::size_t d_;
  base_contents contents_;
};

}  // namespace apsis
