#include <apsis/model/internal/ring_exponentials.hpp>

#include <apsis/model/grid_sums.hpp>
#include <apsis/model/velocity_rows.hpp>

#include <algorithm>
#include <cmath>

namespace apsis::ring_exponentials {
namespace {

aligned_vector<double>& room(std::size_t which) {
  thread_local std::array<aligned_vector<double>, 2> rooms;
  return rooms[which];
}

/// Sums run in four chains, so that compilers can vectorize them. The number of angles is a multiple of four.
constexpr std::size_t lanes = 4;
template <class Body>
void for_lanes(std::size_t n, const Body& body) {
  for (std::size_t first = 0; first < n; first += lanes)
    for (std::size_t lane = 0; lane < lanes; ++lane) body(first + lane, lane);
}
double total(const std::array<double, lanes>& of) {
  return (of[0] + of[1]) + (of[2] + of[3]);
}

/// values ← e^{values − largest}; returns the largest.
double exponentials(aligned_vector<double>& values) {
  const double largest = *std::max_element(values.begin(), values.end());
  velocity_rows::exponentials(largest, static_cast<int>(values.size()), values.data());
  return largest;
}

}  // namespace

factors::factors(const velocity_grid& grid, const fluid_state& state)
    : grid_(grid), at_(grid), state_(state), along_(room(0)), across_(room(1)) {
  along_.resize(grid.last_line().v().size());
  across_.resize(static_cast<std::size_t>(grid.lines()));
}

dual_sums factors::evaluate(const parameters& of) {
  dual_sums found;
  const double shift = add_along(of, found) + add_across(of, found);
  found.log_of_sum += shift;
  return found;
}

void factors::write(double* m) {
  const double factor = state_.rho / (sum_along_ * sum_across_);
  // A subnormal factor would have few digits.
  const bool normal = factor > 1e-290;
  if (normal)
    for (double& one : across_) one *= factor;
  grid_sums::multiply(across_.data(), grid_.lines(), along_.data(), grid_.last_line().points(), m);
  for (int j = 0; j < grid_.size() && !normal; ++j) m[j] = m[j] / (sum_along_ * sum_across_) * state_.rho;
}

/// Adds the sums along the axis. Returns the largest exponent, which the sums omit.
double factors::add_along(const parameters& of, dual_sums& to) {
  const auto& v = grid_.last_line().v();
  const auto& weights = grid_.last_line().weights();
  const double u = state_.u[at_.axis];
  for (std::size_t j = 0; j < v.size(); ++j) {
    const double c = v[j] - u;
    along_[j] = (of[0] + 0.5 * of[3] * c) * c;
  }
  const double largest = exponentials(along_);
  std::array<double, 5> sums{};
  for (std::size_t j = 0; j < v.size(); ++j) {
    const double c = v[j] - u;
    double term = weights[j] * along_[j];
    for (double& sum : sums) {
      sum += term;
      term *= c;
    }
  }
  sum_along_ = sums[0];
  for (double& sum : sums) sum /= sum_along_;
  to.log_of_sum += std::log(sum_along_);
  to.mean[0] = sums[1];
  to.mean[3] += 0.5 * sums[2];
  to.covariance(0, 0) = sums[2] - sums[1] * sums[1];
  to.covariance(0, 3) = to.covariance(3, 0) = 0.5 * (sums[3] - sums[1] * sums[2]);
  to.covariance(3, 3) += 0.25 * (sums[4] - sums[2] * sums[2]);
  return largest;
}

double factors::add_across(const parameters& of, dual_sums& to) {
  const double *v = grid_.component_of_lines(0), *w = grid_.component_of_lines(1),
               *weights = grid_.functions_of_lines().data();
  const double u = state_.u[at_.across[0]], s = state_.u[at_.across[1]];
  const std::size_t n = across_.size();
  double* all = across_.data();
  for (std::size_t j = 0; j < n; ++j) {
    const double c = v[j] - u, d = w[j] - s;
    all[j] = of[1] * c + of[2] * d + 0.5 * of[3] * (c * c + d * d);
  }
  const double largest = exponentials(across_);
  using four = std::array<double, lanes>;
  std::array<four, 4> sums{};  // weighted sums of 1, c, d and q
  for_lanes(n, [&](std::size_t j, std::size_t lane) {
    const double c = v[j] - u, d = w[j] - s, q = 0.5 * (c * c + d * d), one = weights[j] * all[j];
    sums[0][lane] += one;
    sums[1][lane] += one * c;
    sums[2][lane] += one * d;
    sums[3][lane] += one * q;
  });
  sum_across_ = total(sums[0]);
  const std::array<double, 3> mean = {total(sums[1]) / sum_across_, total(sums[2]) / sum_across_,
                                      total(sums[3]) / sum_across_};
  // Products are taken about the means, so that nothing cancels if nearly all mass is at one point.
  std::array<std::array<four, 3>, 3> products{};
  for_lanes(n, [&](std::size_t j, std::size_t lane) {
    const double c0 = v[j] - u, d0 = w[j] - s, one = weights[j] * all[j];
    const double c = c0 - mean[0], d = d0 - mean[1], q = 0.5 * (c0 * c0 + d0 * d0) - mean[2];
    products[0][0][lane] += one * c * c;
    products[0][1][lane] += one * c * d;
    products[1][1][lane] += one * d * d;
    products[0][2][lane] += one * c * q;
    products[1][2][lane] += one * d * q;
    products[2][2][lane] += one * q * q;
  });
  to.log_of_sum += std::log(sum_across_);
  to.mean[1] = mean[0];
  to.mean[2] = mean[1];
  to.mean[3] += mean[2];
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = k; l < 3; ++l) {
      const auto a = static_cast<Eigen::Index>(k + 1), b = static_cast<Eigen::Index>(l + 1);
      to.covariance(a, b) += total(products[k][l]) / sum_across_;
      to.covariance(b, a) = to.covariance(a, b);
    }
  return largest;
}

}  // namespace apsis::ring_exponentials
