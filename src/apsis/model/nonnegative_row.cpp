#include <apsis/model/nonnegative_row.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/QR>

namespace apsis {
namespace {

/// Lawson and Hanson's method for min |A x − b|, x ≥ 0.
class nonnegative_least_squares {
 public:
  nonnegative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) : a_(a), b_(b), rest_(b) {}

  void solve() {
    constexpr int most_changes = 200;
    for (int change = 0; change < most_changes && largest_rest() > rounding; ++change) {
      Eigen::VectorXd slopes = a_.transpose() * rest_;
      for (const Eigen::Index j : chosen_) slopes[j] = 0.0;
      for (const Eigen::Index j : refused_) slopes[j] = 0.0;
      Eigen::Index steepest = 0;
      if (!(slopes.maxCoeff(&steepest) > 0.0)) return;
      chosen_.push_back(steepest);
      values_.conservativeResize(values_.size() + 1);
      values_[values_.size() - 1] = 0.0;
      keep_positive();
      // Because of rounding, a column may be steep without being useful.
      const bool useful = std::find(chosen_.begin(), chosen_.end(), steepest) != chosen_.end();
      if (useful) refused_.clear();
      if (!useful) refused_.push_back(steepest);
    }
  }

  double largest_rest() const { return rest_.cwiseAbs().maxCoeff(); }
  const std::vector<Eigen::Index>& chosen() const { return chosen_; }
  double value(std::size_t k) const { return values_[static_cast<Eigen::Index>(k)]; }

 private:
  static constexpr double rounding = 1e-16;

  /// Solves in the chosen columns. On the way to the solution, removes columns that would become negative.
  void keep_positive() {
    while (!chosen_.empty()) {
      const Eigen::MatrixXd some = a_(Eigen::all, chosen_);
      const Eigen::VectorXd wanted = some.colPivHouseholderQr().solve(b_);
      double part = 1.0;
      std::size_t first = chosen_.size();
      for (std::size_t k = 0; k < chosen_.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        if (wanted[at] > 0.0) continue;
        const double until = values_[at] / (values_[at] - wanted[at]);
        if (first == chosen_.size() || until < part) first = k;
        part = std::min(part, until);
      }
      values_ += part * (wanted - values_);
      rest_ = b_ - some * values_;
      if (first == chosen_.size()) return;
      leave_out(first);
    }
    rest_ = b_;
  }

  void leave_out(std::size_t k) {
    const auto at = static_cast<Eigen::Index>(k), last = values_.size() - 1;
    for (Eigen::Index i = at; i < last; ++i) values_[i] = values_[i + 1];
    values_.conservativeResize(last);
    chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(k));
  }

  const Eigen::MatrixXd& a_;
  const Eigen::VectorXd& b_;
  Eigen::VectorXd rest_, values_;
  std::vector<Eigen::Index> chosen_, refused_;
};

}  // namespace

bool nonnegative_row(const velocity_grid& grid, const double* omega, double* m) {
  const int d = grid.dimensions();
  const double square = 2.0 * omega[d + 1] / omega[0], speed = std::sqrt(square);
  Eigen::MatrixXd functions(d + 2, grid.size());
  Eigen::VectorXd wanted(d + 2);
  wanted[0] = 1.0;
  wanted[d + 1] = 1.0;
  functions.row(0).setOnes();
  for (int k = 0; k < d; ++k) {
    wanted[1 + k] = omega[1 + k] / omega[0] / speed;
    for (int j = 0; j < grid.size(); ++j)
      functions(1 + k, j) = grid.component(k)[static_cast<std::size_t>(j)] / speed;
  }
  for (int j = 0; j < grid.size(); ++j)
    functions(d + 1, j) = 2.0 * grid.half_square()[static_cast<std::size_t>(j)] / square;
  // Columns of equal length make the steepest column the one nearest in direction.
  const Eigen::VectorXd lengths = functions.colwise().norm();
  const Eigen::MatrixXd scaled = functions * lengths.cwiseInverse().asDiagonal();
  nonnegative_least_squares found(scaled, wanted);
  found.solve();
  std::fill_n(m, grid.size(), 0.0);
  for (std::size_t k = 0; k < found.chosen().size(); ++k) {
    const Eigen::Index j = found.chosen()[k];
    m[j] = std::max(found.value(k), 0.0) / lengths[j] * omega[0] /
           grid.set().weights()[static_cast<std::size_t>(j)];
  }
  constexpr double close = 1e-12;
  return found.largest_rest() <= close;
}

}  // namespace apsis
