#include <apsis/steady/anderson.hpp>

#include <apsis/exec/parallel.hpp>
#include <apsis/steady/cell_links.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <Eigen/Dense>

namespace apsis {
namespace {

/// to ← to + factor · from.
void add(double factor, const field& from, field& to) {
  parallel_blocks(to.cells(), cells_of_a_block, [&](int begin, int end) {
    const double* source = from.row(begin);
    double* target = to.row(begin);
    const std::size_t numbers = static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(to.stride());
    for (std::size_t k = 0; k < numbers; ++k) target[k] += factor * source[k];
  });
}

}  // namespace

void anderson::clear() {
  known_ = false;
  changes_.clear();
  changes_of_r_.clear();
}

void anderson::mix(communicator& processes, std::vector<double> r, field& g) {
  if (depth_ == 0) return;
  if (known_) {
    // The oldest change gives its memory to the new one.
    field change;
    if (static_cast<int>(changes_.size()) == depth_) {
      change = std::move(changes_.front());
      changes_.pop_front();
      changes_of_r_.pop_front();
    }
    change = g;
    add(-1.0, last_image_, change);
    changes_.push_back(std::move(change));
    for (std::size_t k = 0; k < r.size(); ++k) last_r_[k] = r[k] - last_r_[k];
    changes_of_r_.push_back(std::move(last_r_));
  }
  last_image_ = g;
  known_ = true;
  if (!changes_.empty()) {
    std::vector<double> theta(changes_.size(), 0.0);
    if (processes.is_root()) theta = shares(r);
    processes.broadcast(std::as_writable_bytes(std::span(theta)));
    for (std::size_t j = 0; j < theta.size(); ++j)
      if (theta[j] != 0.0) add(-theta[j], changes_[j], g);
  }
  last_r_ = std::move(r);
}

/// Returns the θ that minimize ‖r − Σ_j θ_j Δr_j‖₂.
std::vector<double> anderson::shares(const std::vector<double>& r) const {
  const auto rows = static_cast<Eigen::Index>(r.size()), columns = static_cast<Eigen::Index>(changes_.size());
  Eigen::MatrixXd differences(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j)
    differences.col(j) =
        Eigen::Map<const Eigen::VectorXd>(changes_of_r_[static_cast<std::size_t>(j)].data(), rows);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposed;
  decomposed.setThreshold(1e-12);  // images that hardly differ
  decomposed.compute(differences);
  const Eigen::VectorXd theta = decomposed.solve(Eigen::Map<const Eigen::VectorXd>(r.data(), rows));
  return {theta.data(), theta.data() + theta.size()};
}

}  // namespace apsis
