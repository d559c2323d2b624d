#include <apsis/method/rate_errors.hpp>

#include <apsis/method/time_integrator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace apsis {
namespace {

/// Below this z the layer is resolved, and its error is below the rounding of 1/z.
constexpr double resolved = 1e-3;
/// Beyond this z the errors have reached their limit.
constexpr double limit = 1e7;
/// Bound of the slopes that rounding causes in bounded errors between `limit` and twice that.
constexpr double rounding_of_slope = 1e-8;

/// Returns the error of the integral of a layer, from λ(z) and R(−z).
double layer_error(double layer, double decay, double z) {
  return z < resolved ? 0.0 : layer / (1.0 - decay) - 1.0 / z;
}

/// Computes the errors of a method with exact collisions. Stage i multiplies the deviation of its explicit
/// part by e^{−d_i z}. The explicit part deviates by Σ_j (p_ij + w_ij) κ_j + z Σ_j w_ij/r + r_i κ_s.
rate_errors errors_of_exact_collisions(const shu_osher_form<double>& m, double z) {
  const std::size_t s = m.stages();
  const auto initial = initial_weights(m);
  const auto A_hat = to_butcher(m).A_hat;
  std::vector<double> moved(s), of_start(s);
  for (std::size_t i = 0; i < s; ++i) {
    double sum = 0.0, start = initial[i];
    for (std::size_t j = 0; j < i; ++j) {
      sum += (m.P(i, j) + m.W(i, j)) * moved[j] + z * m.W(i, j) / m.r;
      start += (m.P(i, j) + m.W(i, j)) * of_start[j];
    }
    const double left = std::exp(-m.D(i, i) * z);
    moved[i] = left * sum;
    of_start[i] = left * start;
  }
  const double decay = of_start[s - 1], last = moved[s - 1] / (1.0 - decay);
  double flux = 0.0, layer = 0.0;
  for (std::size_t i = 0; i < s; ++i) {
    flux += A_hat(s - 1, i) * (moved[i] + of_start[i] * last);
    layer += A_hat(s - 1, i) * of_start[i];
  }
  return {flux - 1.0, last - 1.0, layer_error(layer, decay, z)};
}

using coefficients_of_s = std::array<double, rate_response::terms>;

/// Returns the monomial coefficients of the polynomial through (nodes, values), by divided differences.
coefficients_of_s interpolate(const coefficients_of_s& nodes, coefficients_of_s values) {
  constexpr std::size_t n = rate_response::terms;
  for (std::size_t order = 1; order < n; ++order)
    for (std::size_t k = n - 1; k >= order; --k)
      values[k] = (values[k] - values[k - 1]) / (nodes[k] - nodes[k - order]);
  coefficients_of_s c{};
  for (std::size_t k = n; k-- > 0;) {  // Horner: c ← c (s − node_k) + value_k
    for (std::size_t j = n - 1; j > 0; --j) c[j] = c[j - 1] - nodes[k] * c[j];
    c[0] = values[k] - nodes[k] * c[0];
  }
  return c;
}

}  // namespace

rate_errors rate_errors_at(const method& m, double z) {
  const auto form = m.coefficients<double>();
  if (solves_exactly(m.kind)) return errors_of_exact_collisions(form, z);
  const auto at = at_finite_rate(to_butcher(form), z);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (m.kind == method_kind::explicit_only && !(std::abs(at.decay) < 1.0))
    return {infinite, infinite, infinite};
  return {at.flux - 1.0, at.last - 1.0, layer_error(at.layer, at.decay, z)};
}

double rate_response::largest(const std::array<double, terms>& c) {
  double most = 0.0;
  for (int k = 0; k <= 100; ++k) {
    const double s = k / 100.0;
    double sum = 0.0;
    for (std::size_t j = terms; j-- > 0;) sum = sum * s + c[j];
    most = std::max(most, std::abs(sum) * (1.0 - s));
  }
  return most;
}

std::optional<rate_response> fit_rate_response(const std::function<rate_errors(double z)>& errors) {
  coefficients_of_s nodes{}, flux{}, last{}, layer{};
  const double slope = (errors(2.0 * limit).last - errors(limit).last) / limit;
  const double growth = std::abs(slope) > rounding_of_slope ? slope : 0.0;
  for (std::size_t k = 0; k < rate_response::terms; ++k) {
    const double angle = std::numbers::pi * static_cast<double>(k) / (rate_response::terms - 1.0);
    nodes[k] = 0.5 * (1.0 - std::cos(angle));
    const double z = std::clamp((1.0 - nodes[k]) / nodes[k], resolved, limit);
    nodes[k] = z < limit ? 1.0 / (1.0 + z) : 0.0;
    const rate_errors at = errors(z);
    if (!std::isfinite(at.flux) || !std::isfinite(at.last) || !std::isfinite(at.layer)) return std::nullopt;
    flux[k] = at.flux / (1.0 - nodes[k]);
    last[k] = (at.last - growth * z) / (1.0 - nodes[k]);
    layer[k] = at.layer;
  }
  return rate_response{interpolate(nodes, flux), interpolate(nodes, last), interpolate(nodes, layer), growth};
}

std::optional<rate_response> compute_rate_response(const method& m) {
  if (m.kind == method_kind::explicit_only || m.kind == method_kind::implicit_only) return std::nullopt;
  return fit_rate_response([&m](double z) { return rate_errors_at(m, z); });
}

std::optional<rate_response> compute_rate_response(const std::string& name) {
  const time_integrator& m = find_integrator(name);
  if (m.one_step() != nullptr) return compute_rate_response(*m.one_step());
  return fit_rate_response([&m](double z) { return m.errors_at(z); });
}

}  // namespace apsis
