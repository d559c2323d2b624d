#include <apsis/phase/grid.hpp>

#include <cmath>

#include <fmt/format.h>

namespace apsis {

grid::grid(int dimensions, std::array<int, 3> cells, std::array<double, 3> lower, std::array<double, 3> upper)
    : dimensions_(dimensions), cells_{1, 1, 1}, first_{}, lower_{}, spacing_{1.0, 1.0, 1.0} {
  if (dimensions < 1 || dimensions > 3)
    throw input_error(fmt::format("{} space dimensions (not 1, 2 or 3); give 1, 2 or 3", dimensions));
  for (int k = 0; k < dimensions; ++k) {
    const double length = upper[at(k)] - lower[at(k)];
    if (cells[at(k)] < 1)
      throw input_error(fmt::format("{} cells (a mesh needs at least one); give more", cells[at(k)]));
    if (!(length > 0.0) || !std::isfinite(length))
      throw input_error(fmt::format(
          "the domain [{}, {}] cannot be used (its length is not positive and finite); give lower < upper",
          lower[at(k)], upper[at(k)]));
    cells_[at(k)] = cells[at(k)];
    lower_[at(k)] = lower[at(k)];
    spacing_[at(k)] = length / cells[at(k)];
  }
  check_size();
  global_ = cells_;
}

grid grid::block(std::array<int, 3> first, std::array<int, 3> cells) const {
  grid part = *this;
  for (int k = 0; k < 3; ++k) {
    const int begin = first[at(k)], count = cells[at(k)];
    if (begin < 0 || count < 1 || begin > cells_[at(k)] - count)
      throw input_error(
          fmt::format("a block of {} cells from cell {} on (direction {} has {} cells); give one inside",
                      count, begin, k + 1, cells_[at(k)]));
    part.cells_[at(k)] = count;
    part.first_[at(k)] = first_[at(k)] + begin;
  }
  return part;
}

void grid::check_size() const {
  const double cells = 1.0 * cells_[0] * cells_[1] * cells_[2];
  if (cells > most_cells)
    throw input_error(
        fmt::format("{:.4g} cells (more than {} cannot be numbered); give fewer", cells, most_cells));
}

double grid::cell_volume() const {
  double volume = 1.0;
  for (int k = 0; k < dimensions_; ++k) volume *= spacing(k);
  return volume;
}

double grid::centre(int cell, int direction) const {
  const int i = cell / stride(direction) % cells(direction);
  return lower_[at(direction)] + spacing(direction) * (first(direction) + i + 0.5);
}

position grid::centre(int cell) const {
  position x{};
  for (int k = 0; k < dimensions_; ++k) x[at(k)] = centre(cell, k);
  return x;
}

int grid::stride(int direction) const {
  int stride = 1;
  for (int k = 2; k > direction; --k) stride *= cells(k);
  return stride;
}

int grid::first_cell(int direction, int pencil) const {
  const int inner = stride(direction);
  return pencil / inner * inner * cells(direction) + pencil % inner;
}

}  // namespace apsis
