#include <apsis/steady/anderson.hpp>

#include <apsis/exec/parallel.hpp>
#include <apsis/steady/cell_links.hpp>

#include <algorithm>
#include <cstddef>
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

void anderson::mix(std::span<const double> r, field& g) {
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
    std::vector<double> of_r(r.begin(), r.end());
    for (std::size_t k = 0; k < of_r.size(); ++k) of_r[k] -= last_r_[k];
    changes_of_r_.push_back(std::move(of_r));
  }
  last_image_ = g;
  last_r_.assign(r.begin(), r.end());
  known_ = true;
  if (changes_.empty()) return;
  const auto rows = static_cast<Eigen::Index>(r.size()), columns = static_cast<Eigen::Index>(changes_.size());
  Eigen::MatrixXd differences(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j)
    differences.col(j) =
        Eigen::Map<const Eigen::VectorXd>(changes_of_r_[static_cast<std::size_t>(j)].data(), rows);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposed;
  decomposed.setThreshold(1e-12);  // images that hardly differ
  decomposed.compute(differences);
  const Eigen::VectorXd theta = decomposed.solve(Eigen::Map<const Eigen::VectorXd>(r.data(), rows));
  for (Eigen::Index j = 0; j < columns; ++j)
    if (theta[j] != 0.0) add(-theta[j], changes_[static_cast<std::size_t>(j)], g);
}

}  // namespace apsis
