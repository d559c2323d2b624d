#include <apsis/steady/tangent_rows.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace apsis {
namespace {

/// Relative size of the differences: about the square root of the rounding of a row.
constexpr double relative_step = 1e-6;
/// Relative size of changes of the relaxing moments, which are 0 in equilibrium.
constexpr double relaxing_step = 1e-4;

}  // namespace

tangent_rows::tangent_rows(const relaxation_model& equation)
    : equation_(equation),
      count_(equation.moment_count()),
      relaxing_(equation.relaxing_count()),
      omega_(at(count_)),
      scales_(at(count_)),
      steps_(at(count_)),
      equilibrium_(at(equation.components())),
      row_(equilibrium_.size()),
      tail_(equilibrium_.size()),
      target_(equilibrium_.size()),
      unchanged_(equilibrium_.size()),
      turned_(equilibrium_.size()),
      changed_(at(count_), equilibrium_),
      column_(at(count_)),
      s_(at(relaxing_)),
      s_of_row_(at(relaxing_)),
      sizes_(at(relaxing_)),
      response_(at(relaxing_ * relaxing_)) {}

bool tangent_rows::move_to(const double* omega) {
  std::copy_n(omega, count_, omega_.begin());
  if (!equation_.equilibrium(omega, equilibrium_.data())) return false;
  if (at(count_) == equation_.invariants().size()) {
    equation_.invariant_scales(omega_, scales_.data());
  } else {
    const double largest = *std::max_element(omega_.begin(), omega_.end(),
                                             [](double a, double b) { return std::abs(a) < std::abs(b); });
    std::fill(scales_.begin(), scales_.end(), std::abs(largest));
  }
  for (int j = 0; j < count_; ++j) {
    steps_[at(j)] = relative_step * std::max(scales_[at(j)], std::numeric_limits<double>::min());
    std::vector<double>& moved = omega_;
    const double here = moved[at(j)];
    moved[at(j)] = here + steps_[at(j)];
    bool found = equation_.equilibrium(moved.data(), changed_[at(j)].data());
    if (!found) {
      steps_[at(j)] = -steps_[at(j)];
      moved[at(j)] = here + steps_[at(j)];
      found = equation_.equilibrium(moved.data(), changed_[at(j)].data());
    }
    moved[at(j)] = here;
    if (!found) return false;
  }
  if (relaxing_ > 0) set_relaxation();
  return true;
}

/// row ← A row.
void tangent_rows::apply(const row_map& map) {
  if (map.turn == nullptr) {
    for (std::size_t k = 0; k < row_.size(); ++k) row_[k] *= map.factors[k];
    return;
  }
  if (turning_.values.empty()) turning_ = map.turn->make_workspace();
  map.turn->apply(row_.data(), row_.size(), map.radius, turning_, turned_.data());
  row_.swap(turned_);
}

/// row ← A ∂E/∂ω_j.
void tangent_rows::difference(int j, const row_map& map) {
  const double per_step = 1.0 / steps_[at(j)];
  const auto& other = changed_[at(j)];
  for (std::size_t k = 0; k < row_.size(); ++k) row_[k] = (other[k] - equilibrium_[k]) * per_step;
  apply(map);
}

void tangent_rows::moments_of(const row_map& map, double* matrix) {
  for (int j = 0; j < count_; ++j) {
    difference(j, map);
    equation_.moments(row_.data(), column_.data());
    for (int i = 0; i < count_; ++i) matrix[i * count_ + j] = column_[at(i)];
  }
}

void tangent_rows::moments_of_deviation(const row_map& cause, const row_map& effect, double* matrix) {
  for (int j = 0; j < count_; ++j) {
    difference(j, cause);
    if (relaxing_ > 0) add_slow_part();
    apply(effect);
    equation_.moments(row_.data(), column_.data());
    for (int i = 0; i < count_; ++i) matrix[i * count_ + j] = column_[at(i)];
  }
}

/// The sizes of s follow from changes of all moments by their scales. They need not be accurate.
void tangent_rows::set_relaxation() {
  equation_.relaxing_moments(equilibrium_.data(), omega_.data(), s_.data());
  std::fill(sizes_.begin(), sizes_.end(), 0.0);
  for (int d = 0; d < equation_.velocities().dimensions(); ++d) {
    const auto speeds = equation_.speeds(d);
    for (int j = 0; j < count_; ++j) {
      difference(j, {.factors = speeds});
      for (std::size_t k = 0; k < row_.size(); ++k) row_[k] = equilibrium_[k] + steps_[at(j)] * row_[k];
      equation_.relaxing_moments(row_.data(), omega_.data(), s_of_row_.data());
      for (int i = 0; i < relaxing_; ++i)
        sizes_[at(i)] =
            std::max(sizes_[at(i)], std::abs(s_of_row_[at(i)] - s_[at(i)]) / relative_step * relaxing_step);
    }
  }
  const double largest = *std::max_element(sizes_.begin(), sizes_.end());
  for (double& size : sizes_)
    if (!(size > 1e-12 * largest)) size = largest;
  std::vector<double> s(at(relaxing_), 0.0);
  set_target(s, 0.0, unchanged_);
  for (int i = 0; i < relaxing_; ++i) {
    std::fill(s.begin(), s.end(), 0.0);
    s[at(i)] = 1.0;
    const bool known = set_tail(s, sizes_[at(i)]);
    for (std::size_t k = 0; k < row_.size(); ++k) row_[k] = equilibrium_[k] + sizes_[at(i)] * tail_[k];
    equation_.relaxing_moments(row_.data(), omega_.data(), s_of_row_.data());
    for (int of = 0; of < relaxing_; ++of)
      response_[at(of * relaxing_ + i)] = known ? (s_of_row_[at(of)] - s_[at(of)]) / sizes_[at(i)] : 0.0;
  }
}

/// tail ← E_s s, as a difference over `size`. Returns false, with tail = 0, if there is no target.
bool tangent_rows::set_tail(const std::vector<double>& s, double size) {
  const bool known = size > 0.0 && set_target(s, size, target_);
  for (std::size_t k = 0; k < tail_.size(); ++k) tail_[k] = known ? (target_[k] - unchanged_[k]) / size : 0.0;
  return known;
}

/// row ← E(ω, s(E) + size s). The row differs from E(ω) even for size = 0 if few velocities give E a heat
/// flux. Returns false, with row = E(ω), if there is no target.
bool tangent_rows::set_target(const std::vector<double>& s, double size, aligned_vector<double>& row) {
  std::vector<double>& moved = s_of_row_;
  double cut = 0.0;
  moved = s_;
  for (std::size_t i = 0; i < s.size(); ++i) moved[i] += size * s[i];
  const bool known = equation_.target(omega_.data(), moved.data(), equilibrium_.data(), 0.0, row.data(), cut);
  if (!known) row = equilibrium_;
  return known;
}

/// For row = G₀ adds E_s s with (1 − 𝒮E_s) s = 𝒮G₀. Collisions then leave the deviation G = G₀ + E_s 𝒮G.
void tangent_rows::add_slow_part() {
  double size = 0.0;
  for (int j = 0; j < count_; ++j) size = std::max(size, std::abs(steps_[at(j)]));
  for (std::size_t k = 0; k < row_.size(); ++k) target_[k] = equilibrium_[k] + size * row_[k];
  equation_.relaxing_moments(target_.data(), omega_.data(), s_of_row_.data());
  Eigen::VectorXd of_row(relaxing_);
  Eigen::MatrixXd left(relaxing_, relaxing_);
  for (int i = 0; i < relaxing_; ++i) {
    of_row[i] = (s_of_row_[at(i)] - s_[at(i)]) / size;
    for (int k = 0; k < relaxing_; ++k) left(i, k) = (i == k ? 1.0 : 0.0) - response_[at(i * relaxing_ + k)];
  }
  const Eigen::VectorXd found = left.colPivHouseholderQr().solve(of_row);
  std::vector<double> s(found.data(), found.data() + relaxing_);
  double share = std::numeric_limits<double>::infinity();
  for (int i = 0; i < relaxing_; ++i)
    if (s[at(i)] != 0.0) share = std::min(share, sizes_[at(i)] / std::abs(s[at(i)]));
  if (!std::isfinite(share) || !set_tail(s, share)) return;
  for (std::size_t k = 0; k < row_.size(); ++k) row_[k] += tail_[k];
}

}  // namespace apsis
