#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include <Eigen/SparseCore>

namespace apsis::bench::peers {

/// The Jacobian of a function f of `cells` × `components` unknowns, by differences. The range of a cell is
/// the set of cells whose f depends on it. Cells with disjoint ranges are perturbed together, one component
/// at a time.
class grouped_jacobian {
 public:
  using vector = Eigen::VectorXd;
  using function = std::function<vector(const vector&)>;

  /// Finds the nonzero entries by large perturbations at `u`: those of whole cells for the groups, then those
  /// of single components.
  grouped_jacobian(int cells, int components, const function& f, const vector& u)
      : components_(components), range_(static_cast<std::size_t>(cells)) {
    const vector value = f(u);
    for (int cell = 0; cell < cells; ++cell) {
      vector moved = u;
      for (int k = 0; k < components; ++k)
        moved[cell * components + k] *= 1.0 + 1e-3 * (k + 1.0) / components;
      const vector change = f(moved) - value;
      for (int other = 0; other < cells; ++other)
        if (change.segment(other * components, components).cwiseAbs().maxCoeff() > 0.0)
          range_[static_cast<std::size_t>(cell)].push_back(other);
    }
    make_groups(cells);
    std::vector<Eigen::Triplet<double>> entries;
    for_each_difference(f, u, 1e-3, [&](int row, int column, double slope) {
      if (slope != 0.0 || row == column) entries.emplace_back(row, column, slope);
    });
    jacobian_.resize(u.size(), u.size());
    jacobian_.setFromTriplets(entries.begin(), entries.end());
  }

  /// Returns the Jacobian at u, always with the same pattern.
  const Eigen::SparseMatrix<double>& operator()(const function& f, const vector& u) {
    std::fill_n(jacobian_.valuePtr(), jacobian_.nonZeros(), 0.0);
    for_each_difference(f, u, std::sqrt(std::numeric_limits<double>::epsilon()),
                        [&](int row, int column, double slope) {
                          if (double* entry = find_entry(row, column)) *entry = slope;
                        });
    return jacobian_;
  }

 private:
  double* find_entry(int row, int column) {
    const int *first = jacobian_.innerIndexPtr() + jacobian_.outerIndexPtr()[column],
              *last = jacobian_.innerIndexPtr() + jacobian_.outerIndexPtr()[column + 1],
              *found = std::lower_bound(first, last, row);
    if (found == last || *found != row) return nullptr;
    return jacobian_.valuePtr() + (found - jacobian_.innerIndexPtr());
  }

  /// Calls use(row, column, slope) for the range of every cell, with relative perturbations `part`.
  template <class Use>
  void for_each_difference(const function& f, const vector& u, double part, const Use& use) const {
    const vector value = f(u);
    for (const auto& group : groups_)
      for (int k = 0; k < components_; ++k) {
        vector moved = u;
        for (const int cell : group) {
          double& x = moved[cell * components_ + k];
          x += part * std::max(1e-5, std::abs(x));
        }
        const vector there = f(moved);
        for (const int cell : group) {
          const int column = cell * components_ + k;
          for (const int other : range_[static_cast<std::size_t>(cell)])
            for (int row = other * components_; row < (other + 1) * components_; ++row)
              use(row, column, (there[row] - value[row]) / (moved[column] - u[column]));
        }
      }
  }

  void make_groups(int cells) {
    std::vector<std::vector<char>> taken;  // [group][cell]: whether a range contains the cell
    for (int cell = 0; cell < cells; ++cell) {
      const auto& range = range_[static_cast<std::size_t>(cell)];
      std::size_t g = 0;
      const auto fits = [&] {
        for (const int other : range)
          if (taken[g][static_cast<std::size_t>(other)] != 0) return false;
        return true;
      };
      while (g < groups_.size() && !fits()) ++g;
      if (g == groups_.size()) {
        groups_.emplace_back();
        taken.emplace_back(static_cast<std::size_t>(cells), char(0));
      }
      groups_[g].push_back(cell);
      for (const int other : range) taken[g][static_cast<std::size_t>(other)] = 1;
    }
  }

  int components_;
  std::vector<std::vector<int>> range_;   ///< range of every cell
  std::vector<std::vector<int>> groups_;  ///< cells that are perturbed together
  Eigen::SparseMatrix<double> jacobian_;
};

}  // namespace apsis::bench::peers
