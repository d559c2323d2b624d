#include <apsis/method/monotonicity.hpp>

#include <apsis/method/lower_product.hpp>

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

bool is_initial(const butcher_form<mp_real>& b, std::size_t i, const mp_real& zero) {
  for (std::size_t j = 0; j <= i; ++j)
    if (abs(b.A_hat(i, j)) > zero || abs(b.A(i, j)) > zero || abs(b.A_dot(i, j)) > zero) return false;
  return true;
}

std::string entry(const char* what, std::size_t i, std::size_t j, const mp_real& value) {
  return fmt::format("{}_{},{} = {:.6g}", what, i + 1, j + 1, value.convert_to<double>());
}

/// Computes R⁻¹ from the columns of A or Ȧ; stages that are u^n get unit columns. Returns nothing, and the
/// reason, if corresponding columns of A and Ȧ are not proportional.
std::optional<matrix<mp_real>> inverse_stage_matrix(const butcher_form<mp_real>& b,
                                                    const std::vector<bool>& merged, const mp_real& zero,
                                                    std::string& reason) {
  const std::size_t s = b.stages();
  auto inverse = matrix<mp_real>::identity(s);
  for (std::size_t j = 0; j < s; ++j) {
    if (merged[j]) continue;
    const bool by_a = abs(b.A(j, j)) > zero;
    const bool by_derivative = abs(b.A_dot(j, j)) > zero;
    if (!by_a && !by_derivative && j + 1 < s) {  // no stage uses the last one
      reason = fmt::format("stage {} has neither Q nor its derivative (d = ddot = 0), so R is not determined",
                           j + 1);
      return std::nullopt;
    }
    for (std::size_t i = j + 1; i < s; ++i) {
      inverse(i, j) = by_a ? b.A(i, j) / b.A(j, j) : b.A_dot(i, j) / b.A_dot(j, j);
      const mp_real other_a = b.A(i, j) - inverse(i, j) * b.A(j, j);
      const mp_real other_derivative = b.A_dot(i, j) - inverse(i, j) * b.A_dot(j, j);
      if (abs(other_a) > zero || abs(other_derivative) > zero) {
        reason =
            entry(abs(other_a) > zero ? "A" : "Adot", i, j, abs(other_a) > zero ? b.A(i, j) : b.A_dot(i, j)) +
            " (Q or its derivative enters explicitly)";
        return std::nullopt;
      }
    }
  }
  return inverse;
}

/// Returns the entry through which Q of a merged stage, that is Q(u^n), enters; such a term is not part of
/// an implicit step.
std::optional<std::string> explicit_collision(const butcher_form<mp_real>& b, const std::vector<bool>& merged,
                                              const mp_real& zero) {
  for (std::size_t j = 0; j < b.stages(); ++j)
    for (std::size_t i = j + 1; merged[j] && i < b.stages(); ++i)
      if (abs(b.A(i, j)) > zero || abs(b.A_dot(i, j)) > zero)
        return entry("A", i, j, b.A(i, j)) + " (Q of a stage without implicit part enters explicitly)";
  return std::nullopt;
}

}  // namespace

ssp_analysis analyse_imex(const butcher_form<mp_real>& b, const mp_real& zero) {
  const std::size_t s = b.stages();
  ssp_analysis result;
  std::vector<bool> merged(s);
  for (std::size_t j = 0; j + 1 < s; ++j) merged[j] = is_initial(b, j, zero);
  if (const auto entry_text = explicit_collision(b, merged, zero)) {
    result.forbids = *entry_text;
    return result;
  }
  const auto inverse = inverse_stage_matrix(b, merged, zero, result.forbids);
  if (!inverse) return result;
  const auto R = inverse_lower(*inverse);
  const auto K = lower_product(R, b.A_hat);
  for (std::size_t i = 0; i < s; ++i) {
    mp_real row_sum(0);
    for (std::size_t j = 0; j <= i; ++j) {
      row_sum += R(i, j);
      if (j < i && !merged[j] && R(i, j) > zero) {
        result.forbids = entry("R", i, j, R(i, j)) + " > 0 (a stage enters with negative weight)";
        return result;
      }
      if (K(i, j) < -zero) {
        result.forbids = entry("(R A_hat)", i, j, K(i, j)) + " < 0";
        return result;
      }
    }
    if (row_sum < -zero) {
      result.forbids = fmt::format("(R e)_{} = {:.6g} < 0", i + 1, row_sum.convert_to<double>());
      return result;
    }
    if (b.A(i, i) < -zero || b.A_dot(i, i) > zero) {
      result.forbids = b.A(i, i) < -zero ? entry("A", i, i, b.A(i, i)) + " < 0"
                                         : entry("Adot", i, i, b.A_dot(i, i)) + " > 0";
      return result;
    }
  }
  // Limits on r: the weight −R_ij of a stage must be at least r K_ij, the weight of its Euler step. For a
  // merged stage it is the weight of u^n, the row sum.
  result.exists = result.unconditional = true;
  result.bounded = false;
  for (std::size_t i = 0; i < s; ++i) {
    mp_real initial(0);
    for (std::size_t j = 0; j <= i; ++j) initial += merged[j] && j < i ? mp_real(0) : R(i, j);
    for (std::size_t j = 0; j < i; ++j) {
      if (K(i, j) <= zero) continue;
      const mp_real ratio = (merged[j] ? initial : mp_real(-R(i, j))) / K(i, j);
      if (!result.bounded || ratio < result.coefficient) {
        result.coefficient = ratio;
        result.forbids = entry("(R A_hat)", i, j, K(i, j)) + " limits r";
      }
      result.bounded = true;
    }
  }
  if (result.bounded && result.coefficient <= zero) {
    result.coefficient = 0;
    result.exists = result.unconditional = false;
  }
  return result;
}

std::optional<matrix<mp_real>> stage_matrix(const butcher_form<mp_real>& b, const mp_real& zero,
                                            std::string& reason) {
  std::vector<bool> merged(b.stages());
  for (std::size_t j = 0; j + 1 < b.stages(); ++j) merged[j] = is_initial(b, j, zero);
  const auto inverse = inverse_stage_matrix(b, merged, zero, reason);
  if (!inverse) return std::nullopt;
  auto R = inverse_lower(*inverse);
  const auto first = std::find(merged.begin(), merged.end(), true);
  if (first == merged.end()) return R;
  // Assign the weight of u^n to the stage that is u^n, whose T enters the Euler steps.
  const auto stage = static_cast<std::size_t>(first - merged.begin());
  for (std::size_t i = stage + 1; i < b.stages(); ++i) {
    if (merged[i]) continue;
    mp_real initial(0);
    for (std::size_t j = 0; j <= i; ++j) initial += R(i, j);
    R(i, stage) -= initial;
  }
  return R;
}

mp_real monotonicity_radius(const matrix<mp_real>& tableau, const mp_real& zero, const mp_real& guess) {
  const std::size_t s = tableau.rows();
  const auto monotone = [&](const mp_real& r) {
    auto shifted = matrix<mp_real>::identity(s);
    for (std::size_t i = 0; i < s; ++i)
      for (std::size_t j = 0; j <= i; ++j) shifted(i, j) += r * tableau(i, j);
    const auto inverse = inverse_lower(shifted);
    const auto weights = lower_product(tableau, inverse);
    for (std::size_t i = 0; i < s; ++i) {
      mp_real rest(0);
      for (std::size_t j = 0; j < s; ++j) {
        if (weights(i, j) < -zero) return false;
        rest += inverse(i, j);
      }
      if (rest < -zero) return false;
    }
    return true;
  };
  if (!monotone(mp_real(0)) || !monotone(mp_real(1e-12))) return 0;
  if (guess > 0 && monotone(guess) && !monotone(guess + 1e6 * zero)) return guess;
  mp_real low(0), high(1);
  while (monotone(high) && high < 1e6) high *= 2;
  for (int k = 0; k < 200 && high - low > mp_real(1e-48) * high; ++k) {
    const mp_real middle = (low + high) / 2;
    (monotone(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace apsis
