#include <apsis/steady/anderson.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/steady/cell_links.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <Eigen/Dense>

namespace apsis {
namespace {

/// Calls body(first, length) for pieces of the numbers of a field.
template <class Body>
void for_pieces(const field& x, const Body& body) {
  const std::size_t stride = at(x.stride());
  parallel_blocks(x.cells(), cells_of_a_block,
                  [&](int begin, int end) { body(at(begin) * stride, at(end - begin) * stride); });
}

std::vector<double> difference_of(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> found(a);
  for (std::size_t k = 0; k < a.size(); ++k) found[k] -= b[k];
  return found;
}

}  // namespace

void move(const field& delta, double share, double factor, field& x) {
  for_pieces(x, [&, from = delta.row(0), to = x.row(0)](std::size_t first, std::size_t length) {
    for (std::size_t k = first; k < first + length; ++k) to[k] = factor * (to[k] + share * from[k]);
  });
}

void anderson::clear() {
  known_ = false;
  last_theta_.clear();
  for (difference& one : differences_) spare_.push_back(std::move(one.of_image));
  differences_.clear();
}

anderson::weights anderson::weigh(communicator& processes, std::vector<double> r,
                                  std::vector<double> of_image) {
  weights found{{}, of_image};
  if (depth_ == 0) return found;
  if (known_) {
    // The new difference takes the memory of the oldest one.
    difference newest;
    if (static_cast<int>(differences_.size()) == depth_) {
      newest = std::move(differences_.front());
      differences_.pop_front();
    } else if (!spare_.empty()) {
      newest.of_image = std::move(spare_.back());
      spare_.pop_back();
    }
    newest.of_r = difference_of(r, last_r_);
    newest.of_functions = difference_of(of_image, last_functions_);
    differences_.push_back(std::move(newest));
    found.theta.assign(differences_.size(), 0.0);
    if (processes.is_root()) found.theta = shares(r);
    processes.broadcast(std::as_writable_bytes(std::span(found.theta)));
    for (std::size_t j = 0; j < found.theta.size(); ++j)
      for (std::size_t k = 0; k < found.of_mixture.size(); ++k)
        found.of_mixture[k] -= found.theta[j] * differences_[j].of_functions[k];
  }
  last_r_ = std::move(r);
  last_functions_ = std::move(of_image);
  return found;
}

/// Returns the differences of the last mixture with their θ. The memory of the newest difference may still
/// contain the oldest of them.
mixture_rows::weighted_differences anderson::of_last_mixture() const {
  mixture_rows::weighted_differences found{last_theta_, {}};
  if (last_theta_.size() == differences_.size() && !last_theta_.empty())
    found.rows.push_back(differences_.back().of_image.row(0));
  for (std::size_t j = 0; found.rows.size() < last_theta_.size(); ++j)
    found.rows.push_back(differences_[j].of_image.row(0));
  return found;
}

void anderson::move(const weights& of, const field& delta, double factor, field& x) {
  if (depth_ == 0) return apsis::move(delta, 1.0, factor, x);
  double* newest = nullptr;
  if (known_) {
    field& memory = differences_.back().of_image;
    if (memory.cells() != x.cells()) memory = field(x.cells(), x.components());
    newest = memory.row(0);
  }
  const mixture_rows::weighted_differences last = of_last_mixture();
  mixture_rows::weighted_differences now{of.theta, {}};
  for (std::size_t j = 0; j < of.theta.size(); ++j) now.rows.push_back(differences_[j].of_image.row(0));
  for_pieces(x, [&, to = x.row(0), from = delta.row(0)](std::size_t first, std::size_t length) {
    mixture_rows::move(first, length, last, last_factor_, newest, now, factor, from, to);
  });
  known_ = true;
  last_theta_ = of.theta;
  last_factor_ = factor;
}

/// Returns the θ that minimize ‖r − Σ_j θ_j Δr_j‖₂.
std::vector<double> anderson::shares(const std::vector<double>& r) const {
  const auto rows = static_cast<Eigen::Index>(r.size()),
             columns = static_cast<Eigen::Index>(differences_.size());
  Eigen::MatrixXd of_r(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j)
    of_r.col(j) =
        Eigen::Map<const Eigen::VectorXd>(differences_[static_cast<std::size_t>(j)].of_r.data(), rows);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> decomposed;
  decomposed.setThreshold(1e-12);  // images that hardly differ
  decomposed.compute(of_r);
  const Eigen::VectorXd theta = decomposed.solve(Eigen::Map<const Eigen::VectorXd>(r.data(), rows));
  return {theta.data(), theta.data() + theta.size()};
}

}  // namespace apsis
