#pragma once

#include <apsis/core/index.hpp>
#include <apsis/steady/cell_links.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace apsis {

/// Cells with their weights in the value at an edge.
struct weighted_cells {
  std::array<std::pair<int, double>, 5> terms{};
  int count = 0;

  void add(int cell, double weight) {
    for (int k = 0; k < count; ++k)
      if (terms[at(k)].first == cell) {
        terms[at(k)].second += weight;
        return;
      }
    terms[at(count++)] = {cell, weight};
  }
  const auto* begin() const { return terms.data(); }
  const auto* end() const { return terms.data() + count; }
};

/// Returns the weights of the value at the upper or lower edge of a whole cell, for molecules that move
/// towards this edge.
weighted_cells edge_of(const cell_links& links, int direction, bool upper, int cell, bool first_order);

/// The derivatives of a flux with respect to the moments of the cells around its face.
class flux_derivative {
 public:
  explicit flux_derivative(std::size_t square) : square_(square) {}

  void add(int cell, double factor, const double* block) {
    std::size_t k = 0;
    while (k < cells_.size() && cells_[k].first != cell) ++k;
    if (k == cells_.size()) {
      if (blocks_.size() == k) blocks_.emplace_back(square_);
      std::fill(blocks_[k].begin(), blocks_[k].end(), 0.0);
      cells_.emplace_back(cell, blocks_[k].data());
    }
    for (std::size_t i = 0; i < square_; ++i) blocks_[k][i] += factor * block[i];
  }
  void clear() { cells_.clear(); }
  auto begin() const { return cells_.begin(); }
  auto end() const { return cells_.end(); }

 private:
  std::size_t square_;
  std::vector<std::pair<int, const double*>> cells_;
  std::vector<std::vector<double>> blocks_;  ///< memory, reused for the next face
};

}  // namespace apsis
