#include <apsis/run/cfl_limit.hpp>

#include <apsis/scheme/reconstruction_registry.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {

std::vector<double> linear_edge(const reconstruction& scheme) {
  // Small enough that nonlinear weights differ from the linear ones by quadratic errors only; large
  // compared with rounding.
  constexpr double small = 1e-7;
  const int g = scheme.ghost_width(), width = 2 * g + 1;
  // Component k of the rows has a disturbance in cell k − g.
  std::vector<std::vector<double>> data(static_cast<std::size_t>(width),
                                        std::vector<double>(static_cast<std::size_t>(width), 1.0));
  std::vector<const double*> rows;
  for (std::size_t k = 0; k < data.size(); ++k) {
    data[k][k] += small;
    rows.push_back(data[k].data());
  }
  std::vector<double> left(data.size()), right(data.size());
  scheme.edges(rows.data() + g, 1, width, left.data(), right.data());
  for (double& c : right) c = (c - 1.0) / small;
  return right;
}

std::complex<double> transport_symbol(const std::vector<double>& edge, double theta) {
  const std::size_t middle = edge.size() / 2;
  const auto g = static_cast<double>(middle);
  std::complex<double> sum = 0.0;
  for (std::size_t k = 0; k < edge.size(); ++k)
    sum += edge[k] * std::polar(1.0, (static_cast<double>(k) - g) * theta);
  return -sum * (1.0 - std::polar(1.0, -theta));
}

namespace {

constexpr double largest_number = 100.0;

/// Returns Δx λ(θ)/v for `count` wavenumbers in (0, π]; the values for −θ are conjugate.
std::vector<std::complex<double>> sample_symbol(const std::vector<double>& edge, int count) {
  std::vector<std::complex<double>> points;
  for (int k = 1; k <= count; ++k) points.push_back(transport_symbol(edge, std::numbers::pi * k / count));
  return points;
}

/// Returns whether all waves are stable at the CFL number nu and Δt/ε = −w.
bool is_stable(const amplification& R, const std::vector<std::complex<double>>& points, double nu, double w) {
  const double bound = std::exp(growth_per_cell * nu);
  return std::all_of(points.begin(), points.end(),
                     [&](const auto& point) { return R.is_within(bound, nu * point, w); });
}

/// Returns by bisection the number in [stable, unstable] up to which `holds` is true.
template <class Holds>
double last_that_holds(const Holds& holds, double stable, double unstable) {
  constexpr int halvings = 24;
  for (int k = 0; k < halvings; ++k) {
    const double middle = (stable + unstable) / 2.0;
    (holds(middle) ? stable : unstable) = middle;
  }
  return stable;
}

/// Returns −Δt/ε for Δt/ε from 0.01 to 1e6, six values per decade. Beyond 1e6, Q̇ has reached its limit.
std::vector<double> stiff_rates() {
  std::vector<double> rates;
  for (int k = -12; k <= 36; ++k) rates.push_back(-std::pow(10.0, k / 6.0));
  return rates;
}

double find_limit(const amplification& R, const std::vector<double>& edge) {
  if (!R.has_transport()) return std::numeric_limits<double>::infinity();
  constexpr double stride = 0.05;
  constexpr int fine = 128, coarse = 32, numbers = 16;
  const auto points = sample_symbol(edge, fine);
  const auto without_collisions = [&](double nu) { return is_stable(R, points, nu, 0.0); };
  double limit = 0.0;
  while (limit < largest_number && without_collisions(limit + stride)) limit += stride;
  if (limit < largest_number) limit = last_that_holds(without_collisions, limit, limit + stride);
  // Collisions do not reduce the limit of any method of type A in the catalogue. Scans from below for the
  // limits of other methods.
  if (R.is_stiff()) {
    const auto few = sample_symbol(edge, coarse);
    const auto rates = stiff_rates();
    const auto with_collisions = [&](double nu) {
      return std::all_of(rates.begin(), rates.end(), [&](double w) { return is_stable(R, few, nu, w); });
    };
    const double whole = limit;
    for (int k = 1; k <= numbers; ++k)
      if (!with_collisions(whole * k / numbers)) {
        limit = last_that_holds(with_collisions, whole * (k - 1) / numbers, whole * k / numbers);
        break;
      }
  }
  return limit < largest_number ? limit : std::numeric_limits<double>::infinity();
}

/// Returns find_limit(). It is computed once for each method and scheme, because every setup needs it.
double known_limit(const amplification& R, const std::vector<double>& edge) {
  static std::mutex access;
  static std::map<std::pair<std::vector<double>, std::vector<double>>, double> known;
  const std::pair key(R.fingerprint(), edge);
  const std::scoped_lock lock(access);
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  return known.emplace(key, find_limit(R, edge)).first->second;
}

std::vector<std::pair<std::string, double>> find_limits(const amplification& R) {
  std::vector<std::pair<std::string, double>> all;
  std::vector<std::vector<double>> edges;
  for (const reconstruction_entry* one : reconstruction_entries()) {
    edges.push_back(linear_edge(*one->make()));
    // Schemes with the same linear weights have the same limit.
    const auto same = std::find_if(edges.begin(), edges.end() - 1, [&](const auto& other) {
      return std::equal(other.begin(), other.end(), edges.back().begin(), edges.back().end(),
                        [](double a, double b) { return std::abs(a - b) < 1e-6; });
    });
    const auto place = static_cast<std::size_t>(same - edges.begin());
    all.emplace_back(one->name, place + 1 < edges.size() ? all[place].second : known_limit(R, edges.back()));
  }
  return all;
}

}  // namespace

double cfl_limit(const amplification& growth, const reconstruction& scheme) {
  return known_limit(growth, linear_edge(scheme));
}

std::vector<std::pair<std::string, double>> cfl_limits(const amplification& growth) {
  return find_limits(growth);
}

std::string cfl_text(const std::vector<std::pair<std::string, double>>& limits) {
  std::vector<std::string> texts;
  std::map<double, std::vector<std::string>, std::greater<>> names;
  for (const auto& [name, limit] : limits) names[limit].push_back(name);
  for (const auto& [limit, with] : names)
    texts.push_back(fmt::format("{:.4g} with {}", limit, fmt::join(with, ", ")));
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace apsis
