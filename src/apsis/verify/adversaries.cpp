#include <apsis/verify/adversaries.hpp>

#include <apsis/core/extremes.hpp>
#include <apsis/core/relaxation_flow.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

namespace apsis {
namespace {

double mass_of(const std::vector<double>& u) {
  return std::accumulate(u.begin(), u.end() - 1, 0.0);
}

}  // namespace

std::vector<std::vector<double>> adversarial_rows(std::size_t cells, int random) {
  std::vector<std::vector<double>> rows(3, std::vector<double>(cells, 0.0));
  for (std::size_t i = 0; i < cells; ++i) {
    rows[0][i] = i < cells / 2 ? 1.0 : 0.0;
    rows[1][i] = i == 0 ? 1.0 : 0.0;
    rows[2][i] = i % 2 == 0 ? 1.0 : 0.0;
  }
  random_source source(3);
  for (int k = 0; k < random; ++k) {
    auto& row = rows.emplace_back(cells);
    for (double& x : row) x = source.one_in(2) ? 0.0 : source.uniform();
  }
  return rows;
}

staged_problem::staged_problem(motion move, equilibrium relax, double epsilon)
    : move_(std::move(move)), relax_(std::move(relax)), epsilon_(epsilon) {
  if (!(epsilon > 0.0)) throw input_error("epsilon is not positive; give epsilon > 0 or infinity");
}

int staged_problem::number_of(double clock) {
  return seen_.emplace(clock, static_cast<int>(seen_.size())).first->second;
}

void staged_problem::add_transport(double, const state& u, std::span<const target<state, double>> targets) {
  accumulate<state>(targets, u, [&]() -> const state& {
    const std::size_t n = u.size() - 1;
    work_.resize(u.size());
    move_(number_of(u[n]), std::span(u).first(n), std::span(work_).first(n));
    for (std::size_t i = 0; i < n; ++i) work_[i] -= u[i];
    work_[n] = u[n];
    return work_;
  });
}

void staged_problem::solve_collision(double, double a, double b, state& u) {
  if (!std::isinf(epsilon_)) relax(relax_weights(a, b, 1.0, epsilon_), u);
}

void staged_problem::advance_collision(double, double s, state& u) {
  if (!std::isinf(epsilon_)) relax(flow_weights(s, 1.0, epsilon_), u);
}

void staged_problem::relax(const relaxation_weights<double>& weights, state& u) {
  const std::size_t n = u.size() - 1;
  work_.resize(u.size());
  relax_(number_of(u[n]), mass_of(u), std::span(work_).first(n));
  for (std::size_t i = 0; i < n; ++i) u[i] = weights.of_u * u[i] + weights.of_e * work_[i];
}

void staged_problem::add_collision(double, const state& u, std::span<const target<state, double>> targets) {
  accumulate<state>(targets, u, [&]() -> const state& {
    const std::size_t n = u.size() - 1;
    work_.assign(u.size(), 0.0);
    if (std::isinf(epsilon_)) return work_;
    relax_(number_of(u[n]), mass_of(u), std::span(work_).first(n));
    for (std::size_t i = 0; i < n; ++i) work_[i] = (work_[i] - u[i]) / epsilon_;
    return work_;
  });
}

// A word is a number in base letters + 1. Its first digit is the equilibrium (0: the initial data), and
// `memory` digits follow. The first letter is the last digit; the digit 0 is no letter.
staged_problem word_problem(int letters, int memory, double epsilon) {
  const auto base = static_cast<std::size_t>(letters) + 1;
  std::size_t words = 1;
  for (int k = 0; k < memory; ++k) words *= base;
  const auto letter = [letters](int k) { return static_cast<std::size_t>(k % letters) + 1; };
  return {[=](int k, std::span<const double> z, std::span<double> out) {
            std::fill(out.begin(), out.end(), 0.0);
            for (std::size_t i = 0; i < z.size(); ++i) {
              const std::size_t origin = i / words, history = i % words;
              out[origin * words + (history * base + letter(k)) % words] += z[i];
            }
          },
          [=](int k, double mass, std::span<double> out) {
            std::fill(out.begin(), out.end(), 0.0);
            out[letter(k) * words] = mass;
          },
          epsilon};
}

std::vector<double> word_data(int letters, int memory) {
  std::size_t cells = 1;
  for (int k = 0; k <= memory; ++k) cells *= static_cast<std::size_t>(letters) + 1;
  std::vector<double> u(cells + 1, 0.0);
  u.front() = u.back() = 1.0;
  return u;
}

staged_problem permutation_problem(int cells, double epsilon, std::uint64_t seed) {
  using permutation = std::vector<std::size_t>;
  const auto known = std::make_shared<std::vector<permutation>>();
  const auto random = std::make_shared<random_source>(seed);
  return {[=](int k, std::span<const double> z, std::span<double> out) {
            while (static_cast<int>(known->size()) <= k) {
              permutation p(static_cast<std::size_t>(cells));
              std::iota(p.begin(), p.end(), std::size_t{0});
              for (int i = cells - 1; i > 0; --i)
                std::swap(p[static_cast<std::size_t>(i)],
                          p[static_cast<std::size_t>(random->integer(0, i + 1))]);
              known->push_back(std::move(p));
            }
            const auto& p = (*known)[static_cast<std::size_t>(k)];
            for (std::size_t i = 0; i < z.size(); ++i) out[p[i]] = z[i];
          },
          [](int, double mass, std::span<double> out) {
            std::fill(out.begin(), out.end(), mass / static_cast<double>(out.size()));
          },
          epsilon};
}

std::vector<std::vector<double>> permutation_data(int cells, int random) {
  auto rows = adversarial_rows(static_cast<std::size_t>(cells), random);
  for (auto& row : rows) row.push_back(1.0);
  return rows;
}

std::function<double(const std::vector<double>&)> random_symmetric_functional(random_source& random,
                                                                              std::size_t ignored) {
  std::vector<std::pair<double, double>> pieces;
  for (int k = 0; k < 4; ++k) pieces.emplace_back(random.uniform(-2, 2), random.uniform(-1, 1));
  return [=](const std::vector<double>& u) {
    double sum = 0.0;
    for (std::size_t i = 0; i + ignored < u.size(); ++i) {
      double h = -std::numeric_limits<double>::infinity();
      for (const auto& [slope, offset] : pieces) h = maximum(h, slope * u[i] + offset);
      sum += h;
    }
    return sum;
  };
}

std::function<double(const std::vector<double>&)> negative_part(std::size_t ignored) {
  return [ignored](const std::vector<double>& u) {
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + ignored < u.size(); ++i)
      lowest = u[i] < lowest || u[i] != u[i] ? u[i] : lowest;
    return -lowest;
  };
}

double total_variation(const std::vector<double>& u) {
  double sum = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) sum += std::abs(u[i] - u[(i + u.size() - 1) % u.size()]);
  return sum;
}

double maximum_norm(const std::vector<double>& u) {
  double largest = 0.0;
  for (const double x : u) largest = maximum(largest, std::abs(x));
  return largest;
}

}  // namespace apsis
