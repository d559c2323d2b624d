#include <apsis/steady/internal/frontal_factors.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/steady/internal/dense_factors.hpp>

#include <algorithm>
#include <limits>
#include <ranges>
#include <utility>

namespace apsis {
namespace {

/// One thread eliminates a subtree with at most 1/groups of the unknowns.
constexpr int groups = 16;

/// Returns the place of an unknown in an increasing list.
int place_in(const std::vector<int>& list, int unknown) {
  return static_cast<int>(std::lower_bound(list.begin(), list.end(), unknown) - list.begin());
}

}  // namespace

frontal_factors::frontal_factors(const std::vector<int>& ends) {
  for (const int end : ends) parts_.push_back({.begin = parts_.empty() ? 0 : parts_.back().end, .end = end});
}

bool frontal_factors::has_pattern_of(const row_matrix& matrix) const {
  const int *starts = matrix.outerIndexPtr(), *numbers = matrix.innerIndexPtr();
  return std::equal(starts_.begin(), starts_.end(), starts, starts + matrix.rows() + 1) &&
         std::equal(column_numbers_.begin(), column_numbers_.end(), numbers, numbers + matrix.nonZeros());
}

void frontal_factors::factorize(const row_matrix& matrix) {
  const column_matrix columns = matrix;
  if (!has_pattern_of(matrix)) {
    starts_.assign(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.rows() + 1);
    column_numbers_.assign(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
    find_borders(columns, matrix);
    find_levels();
    place_fronts();
  }
  for (const auto& level : levels_)
    parallel_tasks(static_cast<int>(level.size()), [&](int k) {
      for (const std::size_t part : level[at(k)]) eliminate(columns, matrix, parts_[part]);
    });
}

void frontal_factors::find_borders(const column_matrix& columns, const row_matrix& rows) {
  const std::size_t unknowns = at(parts_.back().end), parts = parts_.size();
  std::vector<std::size_t> part_of(unknowns);
  for (std::size_t p = 0; p < parts; ++p) {
    std::fill(part_of.begin() + parts_[p].begin, part_of.begin() + parts_[p].end, p);
    parts_[p].border.clear();
    parts_[p].children.clear();
  }
  std::vector<std::size_t> last_visit(unknowns, parts);
  for (std::size_t p = 0; p < parts; ++p) {
    front& part = parts_[p];
    const auto connect = [&](int unknown) {
      if (unknown < part.end || last_visit[at(unknown)] == p) return;
      last_visit[at(unknown)] = p;
      part.border.push_back(unknown);
    };
    for (int k = part.begin; k < part.end; ++k) {
      for (column_matrix::InnerIterator entry(columns, k); entry; ++entry)
        connect(static_cast<int>(entry.row()));
      for (row_matrix::InnerIterator entry(rows, k); entry; ++entry) connect(static_cast<int>(entry.col()));
    }
    for (const std::size_t child : part.children)
      for (const int unknown : parts_[child].border) connect(unknown);
    std::sort(part.border.begin(), part.border.end());
    if (!part.border.empty()) parts_[part_of[at(part.border.front())]].children.push_back(p);
  }
}

void frontal_factors::find_levels() {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  const std::size_t count = parts_.size();
  std::vector<std::size_t> parent(count, none), height(count, 0), group(count, none);
  std::vector<int> unknowns(count);
  for (std::size_t p = 0; p < count; ++p) {
    unknowns[p] += parts_[p].size();
    for (const std::size_t child : parts_[p].children) {
      parent[child] = p;
      unknowns[p] += unknowns[child];
    }
  }
  const int most = parts_.back().end / groups;
  for (std::size_t p = count; p-- > 0;)
    if (unknowns[p] <= most) group[p] = parent[p] != none && group[parent[p]] != none ? group[parent[p]] : p;
  levels_.assign(1, {});
  std::vector<std::size_t> place(count, none);  // place of a group in the first level
  for (std::size_t p = 0; p < count; ++p) {
    if (group[p] != none) {
      std::size_t& here = place[group[p]];
      if (here == none) {
        here = levels_[0].size();
        levels_[0].emplace_back();
      }
      levels_[0][here].push_back(p);
      continue;
    }
    height[p] = 1;
    for (const std::size_t child : parts_[p].children) height[p] = std::max(height[p], height[child] + 1);
    if (levels_.size() <= height[p]) levels_.resize(height[p] + 1);
    levels_[height[p]].push_back({p});
  }
}

void frontal_factors::place_fronts() {
  std::size_t next = 0;
  for (front& part : parts_) {
    part.first = next;
    next += at(part.size()) * (at(part.size()) + 2 * part.border.size());
    part.pivots.resize(at(part.size()));
  }
  if (numbers_.size() != next) numbers_ = stored_numbers(next, host_memory());
}

// In the block of a part, its own rows precede those of its border.
frontal_factors::block frontal_factors::inside(const front& part) {
  return {numbers_.data() + part.first, part.size(), part.size(), part.size() + part.border_size()};
}

frontal_factors::block frontal_factors::below(const front& part) {
  return {inside(part).first + part.size(), part.border_size(), part.size(), inside(part).stride};
}

frontal_factors::block frontal_factors::right(const front& part) {
  return {inside(part).first + part.size() * inside(part).stride, part.size(), part.border_size(),
          part.size()};
}

void frontal_factors::eliminate(const column_matrix& columns, const row_matrix& rows, front& part) {
  std::fill_n(numbers_.data() + part.first, at(part.size()) * (at(part.size()) + 2 * part.border.size()),
              0.0);
  part.schur_complement.assign(part.border.size() * part.border.size(), 0.0);
  add_entries(columns, rows, part);
  for (const std::size_t child : part.children) add_schur_complement(parts_[child], part);
  if (!dense_factors::factorize(inside(part), part.pivots))
    throw numerical_error("the moment equations of the steady state are singular", {});
  dense_factors::exchange_pivot_rows(part.pivots, right(part));
  dense_factors::solve_lower(inside(part), right(part));
  dense_factors::solve_upper_from_right(inside(part), below(part));
  const int border = part.border_size();
  dense_product::subtract(below(part), right(part), {part.schur_complement.data(), border, border, border});
}

void frontal_factors::add_entries(const column_matrix& columns, const row_matrix& rows, const front& part) {
  const block of_part = inside(part), of_columns = below(part), of_rows = right(part);
  for (int k = part.begin; k < part.end; ++k) {
    for (column_matrix::InnerIterator entry(columns, k); entry; ++entry) {
      const int row = static_cast<int>(entry.row());
      if (row >= part.end)
        of_columns(place_in(part.border, row), k - part.begin) = entry.value();
      else if (row >= part.begin)
        of_part(row - part.begin, k - part.begin) = entry.value();
    }
    for (row_matrix::InnerIterator entry(rows, k); entry; ++entry)
      if (const int column = static_cast<int>(entry.col()); column >= part.end)
        of_rows(k - part.begin, place_in(part.border, column)) = entry.value();
  }
}

void frontal_factors::add_schur_complement(front& from, front& to) {
  const int count = from.border_size(), of_border = to.border_size(),
            within = place_in(from.border, to.end);  // number of unknowns that belong to the part
  std::vector<int> places;
  for (const int unknown : from.border)
    places.push_back(unknown < to.end ? unknown - to.begin : place_in(to.border, unknown));
  const block later{to.schur_complement.data(), of_border, of_border, of_border};
  for (int column = 0; column < count; ++column) {
    const block above = column < within ? inside(to) : right(to), under = column < within ? below(to) : later;
    const double* left = from.schur_complement.data() + at(column) * at(count);
    const int j = places[at(column)];
    for (int k = 0; k < within; ++k) above(places[at(k)], j) += left[k];
    for (int k = within; k < count; ++k) under(places[at(k)], j) += left[k];
  }
  from.schur_complement = aligned_vector<double>();  // {} would not release its memory
}

frontal_factors::matrix_view frontal_factors::inside(const front& part) const {
  return {numbers_.data() + part.first, part.size(), part.size(),
          Eigen::OuterStride<>(part.size() + part.border_size())};
}

frontal_factors::matrix_view frontal_factors::below(const front& part) const {
  return {inside(part).data() + part.size(), part.border_size(), part.size(),
          Eigen::OuterStride<>(part.size() + part.border_size())};
}

frontal_factors::matrix_view frontal_factors::right(const front& part) const {
  return {inside(part).data() + part.size() * inside(part).outerStride(), part.size(), part.border_size(),
          Eigen::OuterStride<>(part.size())};
}

Eigen::VectorXd frontal_factors::solve(const Eigen::VectorXd& r) const {
  Eigen::VectorXd x = r;
  for (const front& part : parts_) {
    auto here = x.segment(part.begin, part.size());
    for (int k = 0; k < part.size(); ++k) std::swap(here[k], here[part.pivots[at(k)]]);
    inside(part).triangularView<Eigen::UnitLower>().solveInPlace(here);
    x(part.border) -= below(part) * here;
  }
  for (const front& part : std::views::reverse(parts_)) {
    auto here = x.segment(part.begin, part.size());
    here -= right(part) * x(part.border);
    inside(part).triangularView<Eigen::Upper>().solveInPlace(here);
  }
  return x;
}

Eigen::VectorXd frontal_factors::solve_transposed(const Eigen::VectorXd& r) const {
  Eigen::VectorXd x = r;
  for (const front& part : parts_) {
    auto here = x.segment(part.begin, part.size());
    inside(part).transpose().triangularView<Eigen::Lower>().solveInPlace(here);
    x(part.border) -= right(part).transpose() * here;
  }
  for (const front& part : std::views::reverse(parts_)) {
    auto here = x.segment(part.begin, part.size());
    here -= below(part).transpose() * x(part.border);
    inside(part).transpose().triangularView<Eigen::UnitUpper>().solveInPlace(here);
    for (int k = part.size(); k-- > 0;) std::swap(here[k], here[part.pivots[at(k)]]);
  }
  return x;
}

}  // namespace apsis
