#include <apsis/integrate/sparsity_pattern.hpp>

#include <apsis/core/errors.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace apsis {

sparsity_pattern::sparsity_pattern(std::size_t n, const std::vector<place>& places) {
  if (n == 0) throw input_error("a sparsity pattern has no unknowns (n is 0); give their number");
  std::vector<std::vector<std::size_t>> columns(n);
  for (const auto& [row, column] : places) {
    if (row >= n || column >= n)
      throw input_error(
          fmt::format("the place ({}, {}) is outside of the derivative of {} unknowns (rows and "
                      "columns count from 0); give places below {}",
                      row, column, n, n));
    columns[column].push_back(row);
  }
  begin_.push_back(0);
  for (std::size_t j = 0; j < n; ++j) {
    auto& rows = columns[j];
    rows.push_back(j);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    begin_.push_back(rows_.size());
  }
  group_columns();
}

sparsity_pattern sparsity_pattern::banded(std::size_t n, std::size_t lower, std::size_t upper) {
  std::vector<place> places;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = j < upper ? 0 : j - upper; i < n && i <= j + lower; ++i) places.emplace_back(i, j);
  return {n, places};
}

sparsity_pattern sparsity_pattern::joined_with(std::vector<place> more) const {
  for (std::size_t j = 0; j < size(); ++j)
    for (const std::size_t i : rows(j)) more.emplace_back(i, j);
  return {size(), more};
}

void sparsity_pattern::group_columns() {
  const std::size_t n = size();
  // Columns with an entry in each row, to find the neighbours of a column.
  std::vector<std::vector<std::size_t>> in_row(n);
  for (std::size_t j = 0; j < n; ++j)
    for (const std::size_t i : rows(j)) in_row[i].push_back(j);
  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> group_of(n, none), taken_by;
  for (std::size_t j = 0; j < n; ++j) {
    taken_by.assign(groups_.size(), none);
    for (const std::size_t i : rows(j))
      for (const std::size_t k : in_row[i])
        if (group_of[k] != none) taken_by[group_of[k]] = k;
    const auto free =
        static_cast<std::size_t>(std::find(taken_by.begin(), taken_by.end(), none) - taken_by.begin());
    if (free == groups_.size()) groups_.emplace_back();
    groups_[free].push_back(j);
    group_of[j] = free;
  }
}

}  // namespace apsis
