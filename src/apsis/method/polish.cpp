#include <apsis/method/polish.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/method/coefficient.hpp>
#include <apsis/method/order_conditions.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace apsis {
namespace {

using mp_vector = std::vector<mp_real>;

mp_real dot(const mp_vector& a, const mp_vector& b) {
  mp_real sum(0);
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// The free coefficients, as pointers into a form, and the equations that they must satisfy.
class coefficient_system {
 public:
  coefficient_system(method& m, const polish_conditions& more)
      : source_(m), more_(more), form_(m.coefficients<mp_real>()) {
    const auto free = [](const std::string& text) { return decimals(text) > 0; };
    for (std::size_t i = 0; i < m.stages(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (free(m.exact.P(i, j))) add(form_.P(i, j), m.exact.P(i, j));
        if (free(m.exact.W(i, j))) add(form_.W(i, j), m.exact.W(i, j));
      }
      for (std::size_t j = 0; j <= i; ++j)
        if (free(m.exact.D(i, j))) add(form_.D(i, j), m.exact.D(i, j));
      if (free(m.exact.ddot[i])) add(form_.ddot[i], m.exact.ddot[i]);
    }
    if (free(m.exact.r)) add(form_.r, m.exact.r);
    const auto initial = initial_weights(form_);
    const auto weights = to_butcher(form_).A_hat;
    for (std::size_t i = 0; i < m.stages(); ++i) {
      full_row_.push_back(i > 0 && abs(initial[i]) < mp_real(1e-12));
      counts_.push_back(abs(weights(m.stages() - 1, i)) > mp_real(1e-12));
    }
    trees_ = rooted_trees(m.claims.order, colours_of(m.kind));
  }

  std::size_t unknowns() const { return values_.size(); }
  mp_real& value(std::size_t k) { return *values_[k]; }
  std::string& text(std::size_t k) { return *texts_[k]; }

  /// Residuals of the order conditions, of full rows, of c = ĉ where T contributes (order 3 and higher), and
  /// of the additional conditions.
  mp_vector residuals() const {
    const auto b = to_butcher(form_);
    auto equations = elementary_weights(b, trees_);
    for (std::size_t k = 0; k < trees_.size(); ++k) equations[k] -= mp_real(1) / mp_real(trees_[k].density);
    const auto initial = initial_weights(form_);
    for (std::size_t i = 0; i < full_row_.size(); ++i) {
      if (full_row_[i]) equations.push_back(initial[i]);
      if (source_.kind != method_kind::imex || source_.claims.order < 3 || !counts_[i]) continue;
      mp_real difference(0);
      for (std::size_t j = 0; j <= i; ++j) difference += b.A(i, j) - b.A_hat(i, j);
      equations.push_back(difference);
    }
    if (more_)
      for (const auto& missing : more_(form_)) equations.push_back(missing);
    return equations;
  }

  /// Gradients of all equations by finite differences. In 60 digits a step of 1e-28 has an error of about
  /// 1e-28. Newton's method then converges by a factor of 1e-28 per step instead of quadratically.
  std::vector<mp_vector> gradients() {
    const mp_real step(1e-28);
    const auto base = residuals();
    std::vector<mp_vector> rows(base.size(), mp_vector(unknowns()));
    for (std::size_t k = 0; k < unknowns(); ++k) {
      const mp_real kept = value(k);
      value(k) = kept + step;
      const auto moved = residuals();
      value(k) = kept;
      for (std::size_t e = 0; e < base.size(); ++e) rows[e][k] = (moved[e] - base[e]) / step;
    }
    return rows;
  }

 private:
  void add(mp_real& value, std::string& text) {
    values_.push_back(&value);
    texts_.push_back(&text);
  }

  method& source_;
  const polish_conditions& more_;
  shu_osher_form<mp_real> form_;
  std::vector<mp_real*> values_;
  std::vector<std::string*> texts_;
  std::vector<bool> full_row_, counts_;
  std::vector<rooted_tree> trees_;
};

/// Selects equations with linearly independent gradients by Gram–Schmidt with pivoting on the largest
/// remainder; the printed digits leave dependent equations a remainder of about 1e-14.
std::vector<std::size_t> independent(const std::vector<mp_vector>& gradients) {
  std::vector<std::size_t> chosen;
  auto rest = gradients;
  while (true) {
    std::size_t best = rest.size();
    mp_real largest(1e-8);
    for (std::size_t e = 0; e < rest.size(); ++e) {
      const mp_real size = sqrt(dot(rest[e], rest[e]));
      if (size > largest) {
        largest = size;
        best = e;
      }
    }
    if (best == rest.size()) break;
    chosen.push_back(best);
    const mp_vector direction = rest[best];
    const mp_real square = dot(direction, direction);
    for (auto& row : rest) {
      const mp_real along = dot(row, direction) / square;
      for (std::size_t k = 0; k < row.size(); ++k) row[k] -= along * direction[k];
    }
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// Solves the symmetric positive definite system ax = b by Gaussian elimination.
mp_vector solve(std::vector<mp_vector> a, mp_vector b) {
  const std::size_t n = b.size();
  for (std::size_t p = 0; p < n; ++p)
    for (std::size_t i = p + 1; i < n; ++i) {
      const mp_real factor = a[i][p] / a[p][p];
      for (std::size_t j = p; j < n; ++j) a[i][j] -= factor * a[p][j];
      b[i] -= factor * b[p];
    }
  for (std::size_t p = n; p-- > 0;) {
    for (std::size_t j = p + 1; j < n; ++j) b[p] -= a[p][j] * b[j];
    b[p] /= a[p][p];
  }
  return b;
}

/// Maximum norm; NaN if any entry is NaN. std::max alone would drop it.
mp_real largest_of(const mp_vector& v) {
  mp_real largest(0);
  for (const auto& x : v) {
    if (isnan(x)) return x;
    largest = std::max(largest, mp_real(abs(x)));
  }
  return largest;
}

/// Returns the solution d of J d = right that minimizes Σ w_k d_k²: d = S Jᵀ (J S Jᵀ)⁻¹ right, S = diag(1/w).
mp_vector least_change(const std::vector<mp_vector>& J, const mp_vector& right, const mp_vector& scale,
                       mp_vector* multipliers_out = nullptr) {
  const std::size_t n = J.size();
  std::vector<mp_vector> normal(n, mp_vector(n));
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b)
      for (std::size_t k = 0; k < scale.size(); ++k) normal[a][b] += J[a][k] * scale[k] * J[b][k];
  const auto multipliers = solve(normal, right);
  if (multipliers_out != nullptr) *multipliers_out = multipliers;
  mp_vector d(scale.size());
  for (std::size_t k = 0; k < d.size(); ++k)
    for (std::size_t a = 0; a < n; ++a) d[k] += scale[k] * J[a][k] * multipliers[a];
  return d;
}

/// Returns scales for which the minimal change is small in every coefficient, not only in the sum: Lawson's
/// iteration increases the weight of coefficients that move far. Sets `bound` to a lower bound of max |d|
/// over all solutions of J d = right: y·right = (Jᵀy)·d ≤ Σ|Jᵀy| max|d| for every y.
mp_vector even_scales(const std::vector<mp_vector>& J, const mp_vector& right, mp_real& bound) {
  const std::size_t n = J.empty() ? 0 : J.front().size();
  mp_vector weight(n, mp_real(1)), best_scale(n, mp_real(1));
  mp_real best(-1);
  for (int iteration = 0; iteration < 400; ++iteration) {
    mp_vector scale(n);
    for (std::size_t k = 0; k < n; ++k) scale[k] = 1 / weight[k];
    mp_vector y;
    const auto d = least_change(J, right, scale, &y);
    const mp_real largest = largest_of(d);
    mp_real total(0);
    for (std::size_t k = 0; k < n; ++k) total += abs(d[k]) * weight[k];  // Jᵀy = d/S
    if (total > 0) bound = std::max(bound, mp_real(abs(dot(y, right)) / total));
    if (best < 0 || largest < best) {
      best = largest;
      best_scale = scale;
    }
    if (largest == 0) break;
    mp_real sum(0);
    for (std::size_t k = 0; k < n; ++k) {
      weight[k] *= abs(d[k]) / largest + mp_real(1e-12);
      sum += weight[k];
    }
    // Keep the weights in a range in which the normal equations are well conditioned.
    for (auto& w : weight) w = std::max(mp_real(w * mp_real(n) / sum), mp_real(1e-14));
  }
  return best_scale;
}

}  // namespace

polish_result polish(const method& m, int digits, const polish_conditions& conditions) {
  if (solves_exactly(m.kind))
    throw input_error(
        fmt::format("'{}' cannot be polished (it is {}, and the conditions are those of "
                    "stages that are solved implicitly); choose an implicit or IMEX method",
                    m.name, to_string(m.kind)));
  polish_result result{m, 0, 0, 0};
  coefficient_system equations(result.polished, conditions);
  const std::size_t n = equations.unknowns();
  mp_vector start;
  for (std::size_t k = 0; k < n; ++k) start.push_back(equations.value(k));

  std::vector<std::size_t> chosen;
  mp_vector scale;
  for (int iteration = 0; iteration < 20 && n > 0; ++iteration) {
    const auto gradients = equations.gradients();
    const auto residuals = equations.residuals();
    if (iteration == 0) chosen = independent(gradients);
    std::vector<mp_vector> J;
    mp_vector right;
    for (const std::size_t e : chosen) {
      J.push_back(gradients[e]);
      right.push_back(-residuals[e]);
    }
    if (iteration == 0) scale = even_scales(J, right, result.smallest_possible_move);
    const auto step = least_change(J, right, scale);
    for (std::size_t k = 0; k < n; ++k) equations.value(k) += step[k];
    if (largest_of(step) < mp_real(1e-54)) break;
  }
  result.residual = largest_of(equations.residuals());
  if (!(result.residual < pow(mp_real(10), -digits)))
    throw numerical_error(fmt::format("polishing '{}' did not converge (residual {}); start from more digits",
                                      m.name, result.residual.str(3)));
  for (std::size_t k = 0; k < n; ++k) {
    result.largest_move = std::max(result.largest_move, mp_real(abs(equations.value(k) - start[k])));
    equations.text(k) = equations.value(k).str(digits, std::ios_base::fixed);
  }
  return result;
}

}  // namespace apsis
