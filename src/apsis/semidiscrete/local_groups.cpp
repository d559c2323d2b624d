#include <apsis/semidiscrete/local_groups.hpp>

#include <apsis/core/index.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace apsis {

local_groups::local_groups(const domain& space) : space_(space), cut_(*space.mesh().cut()) {
  plan();
}

int local_groups::holder(int cell) const {
  const distribution* shared = space_.shared_mesh();
  return shared == nullptr ? 0 : shared->holder(cell);
}

int local_groups::number_here(int cell) const {
  return space_.number_in_block(cell);
}

/// Returns the processes that have the row of a cell: all processes with a cell of its group.
std::vector<int> local_groups::holders(int cell) const {
  const int group = cut_.group_of(cell);
  if (group < 0) return {holder(cell)};
  std::set<int> found;
  for (const int one : cut_.groups()[at(group)].cells) found.insert(holder(one));
  return {found.begin(), found.end()};
}

/// Returns the cell with the number that identifies a row.
int local_groups::key_of(int cell) const {
  const int group = cut_.group_of(cell);
  return group < 0 ? cell : cut_.groups()[at(group)].cells.front();
}

/// Every process computes which process needs which rows, without communication.
void local_groups::plan() {
  const int here = space_.processes().rank();
  std::vector<shared_row> rows, values;
  for (std::size_t number = 0; number < cut_.groups().size(); ++number) {
    const cut_group& group = cut_.groups()[number];
    const int first = group.cells.front();
    const std::vector<int> with_cells = holders(first);
    std::set<int> with_line(with_cells.begin(), with_cells.end());
    std::set<int> seen = {first};
    for (const int f : group.faces) {
      const open_face& one = cut_.faces()[at(f)];
      for (const int cell : {one.below, one.above}) {
        if (cell < 0 || cut_.group_of(cell) == static_cast<int>(number)) continue;
        seen.insert(key_of(cell));
        for (const int process : holders(cell)) with_line.insert(process);
        if (cut_.group_of(cell) >= 0) continue;
        for (const int process : with_cells)
          if (process != holder(cell)) values.push_back({f, holder(cell), process});
      }
    }
    if (with_line.count(here) > 0) fitted_.push_back(static_cast<int>(number));
    for (const int cell : seen) {
      const std::vector<int> have = holders(cell);
      for (const int process : with_line) {
        if (std::find(have.begin(), have.end(), process) != have.end()) continue;
        rows.push_back({cell, holder(cell), process});
        if (holder(cell) == here) sent_.push_back(number_here(cell));
      }
    }
  }
  if (!space_.shared()) return;
  rows_ = shared_rows(space_.shared_mesh()->processes, std::move(rows));
  faces_ = shared_rows(space_.shared_mesh()->processes, std::move(values));
}

std::vector<int> local_groups::cells_here(int group) const {
  std::vector<int> found;
  for (const int cell : cut_.groups()[at(group)].cells)
    if (const int number = number_here(cell); number >= 0) found.push_back(number);
  return found;
}

int local_groups::place_of(int cell) const {
  const int group = cut_.group_of(cell);
  if (group >= 0) {
    const std::vector<int> own = cells_here(group);
    if (!own.empty()) return own.front();
  } else if (const int number = number_here(cell); number >= 0) {
    return number;
  }
  return -1 - rows_.place_of(key_of(cell));
}

void local_groups::exchange(const field& u) {
  if (!space_.shared()) return;
  rows_.exchange(u.stride(), [&](int cell) { return u.row(number_here(cell)); });
}

void local_groups::exchange_at_faces(int length, const std::function<const double*(int face)>& values) {
  if (space_.shared()) faces_.exchange(length, values);
}

}  // namespace apsis
