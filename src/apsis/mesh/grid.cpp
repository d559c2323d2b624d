#include <apsis/mesh/grid.hpp>

#include <apsis/mesh/cut_cells.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace apsis {

grid::grid(int dimensions, std::array<int, 3> cells, std::array<double, 3> lower, std::array<double, 3> upper)
    : dimensions_(dimensions), cells_{1, 1, 1}, first_{}, whole_cells_{}, lower_{}, spacing_{1.0, 1.0, 1.0} {
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
  whole_cells_ = cells_;
  check_size();
  find_fluid();
}

bool grid::has_cells_of(const grid& other) const {
  return dimensions_ == other.dimensions_ && cells_ == other.cells_ && first_ == other.first_ &&
         lower_ == other.lower_ && spacing_ == other.spacing_ && solids_ == other.solids_;
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
  part.solids_.clear();
  part.solid_.reset();
  part.group_.reset();
  part.find_fluid();
  std::vector<cell_box> inside;
  for (cell_box box : solids_) {
    bool meets = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const int begin = std::max(box.first[k] - first[k], 0),
                end = std::min(box.first[k] + box.cells[k] - first[k], cells[k]);
      meets = meets && begin < end;
      box.first[k] = begin;
      box.cells[k] = end - begin;
    }
    // Empty boxes stay in the list, so that boxes have the same numbers in all blocks.
    if (!meets) box.cells = {0, 0, 0};
    inside.push_back(box);
  }
  if (!inside.empty()) part.set_solids(std::move(inside));
  if (cut_) part.copy_bodies(*this);
  if (part.fluid_.empty()) part.fluid_.push_back({0, 0});
  return part;
}

grid grid::about_axis() const {
  if (dimensions_ > 2)
    throw input_error(
        fmt::format("an axis in {} dimensions (r is the last of one or two); leave it out", dimensions_));
  if (lower_[at(dimensions_ - 1)] < 0.0)
    throw input_error(
        fmt::format("an axis in a mesh from r = {:.6g} on (r is the distance from it); begin at 0 "
                    "or above",
                    lower_[at(dimensions_ - 1)]));
  grid made = *this;
  made.has_axis_ = true;
  return made;
}

grid grid::with_solids(std::vector<cell_box> boxes) const {
  for (const cell_box& box : boxes)
    for (std::size_t k = 0; k < 3; ++k)
      if (box.first[k] < 0 || box.cells[k] < 1 || box.first[k] > cells_[k] - box.cells[k])
        throw input_error(fmt::format(
            "a solid box of {} cells from cell {} on (direction {} has {} cells); give one inside",
            box.cells[k], box.first[k], k + 1, cells_[k]));
  grid made = *this;
  made.set_solids(std::move(boxes));
  if (made.fluid_.empty()) throw input_error("no cell is left (all are solid); give smaller boxes");
  return made;
}

void grid::set_solids(std::vector<cell_box> boxes) {
  solids_ = std::move(boxes);
  solid_ = std::make_shared<std::vector<int>>(at(size()), -1);
  for (std::size_t number = 0; number < solids_.size(); ++number) {
    const auto& [first, cells] = solids_[number];
    for (int i = first[0]; i < first[0] + cells[0]; ++i)
      for (int j = first[1]; j < first[1] + cells[1]; ++j)
        std::fill_n(
            solid_->begin() + ((static_cast<std::ptrdiff_t>(i) * cells_[1] + j) * cells_[2] + first[2]),
            cells[2], static_cast<int>(number));
  }
  find_fluid();
}

grid grid::with_cut_cells(std::shared_ptr<const cut_cells> cut) const {
  if (cut_) throw input_error("a mesh with cut cells cannot be cut again; give all bodies together");
  if (is_block())
    throw input_error(
        "a block of a larger mesh cannot be cut (groups of cut cells may reach beyond it); cut the larger "
        "mesh, then take the block");
  if (!has_cells_of(cut->mesh()))
    throw input_error(
        "the cut cells belong to another mesh (it has other cells or solid boxes); make them for this mesh");
  grid made = *this;
  made.whole_ = std::make_shared<const grid>(*this);
  made.bodies_ = cut->bodies();
  made.cut_ = std::move(cut);
  made.solid_ = solid_ ? std::make_shared<std::vector<int>>(*solid_)
                       : std::make_shared<std::vector<int>>(at(size()), -1);
  made.group_ = std::make_shared<std::vector<int>>(at(size()), -1);
  for (int cell = 0; cell < size(); ++cell) {
    if (const int body = made.cut_->body_of(cell); body >= 0)
      (*made.solid_)[at(cell)] = static_cast<int>(solids_.size()) + body;
    (*made.group_)[at(cell)] = made.cut_->group_of(cell);
  }
  made.find_fluid();
  return made;
}

/// Copies the bodies of the whole mesh to this block.
void grid::copy_bodies(const grid& whole) {
  if (!solid_) solid_ = std::make_shared<std::vector<int>>(at(size()), -1);
  group_ = std::make_shared<std::vector<int>>(at(size()), -1);
  for (int cell = 0; cell < size(); ++cell) {
    const int there = whole.cell_of(*this, cell);
    (*solid_)[at(cell)] = whole.solid(there);
    (*group_)[at(cell)] = whole.cut_group(there);
  }
  find_fluid();
}

double grid::gas_share(int cell) const {
  return cut_group(cell) < 0 ? 1.0 : cut_->volume_of(whole_->cell_of(*this, cell)) / cell_volume();
}

void grid::find_fluid() {
  fluid_.clear();
  if (!solid_) {
    fluid_.push_back({0, size()});
    return;
  }
  for (int cell = 0; cell < size(); ++cell) {
    if (solid(cell) >= 0) continue;
    if (fluid_.empty() || fluid_.back().end != cell) fluid_.push_back({cell, cell});
    ++fluid_.back().end;
  }
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
  if (const int group = cut_group(cell); group >= 0) return cut_->groups()[at(group)].centre;
  position x{};
  for (int k = 0; k < dimensions_; ++k) x[at(k)] = centre(cell, k);
  return x;
}

int grid::stride(int direction) const {
  int stride = 1;
  for (int k = 2; k > direction; --k) stride *= cells(k);
  return stride;
}

int grid::cell_of(const grid& block, int cell) const {
  int number = 0;
  for (int k = 0; k < 3; ++k)
    number += (cell / block.stride(k) % block.cells(k) + block.first(k) - first(k)) * stride(k);
  return number;
}

int grid::first_cell(int direction, int pencil) const {
  const int inner = stride(direction);
  return pencil / inner * inner * cells(direction) + pencil % inner;
}

}  // namespace apsis
