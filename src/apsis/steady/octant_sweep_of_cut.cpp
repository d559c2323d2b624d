// Cut cells in an octant sweep.
#include <apsis/core/index.hpp>
#include <apsis/steady/octant_sweep.hpp>

#include <algorithm>
#include <functional>
#include <queue>

namespace apsis {

/// Returns the cells whose changes enter a cell in an octant.
std::vector<int> octant_sweep::upstream_of(const octant& of, int cell) const {
  std::vector<int> found;
  const int group = cut_.group_of(cell);
  if (group >= 0) {
    for (const way_out_of_cut& way : cut_.groups()[at(group)].ways)
      for (int d = 0; d < links_.directions() && way.other >= 0 && !way.is_image; ++d)
        if (way.normal[at(d)] != 0.0 && (way.normal[at(d)] > 0.0) != of.up[at(d)]) found.push_back(way.other);
    return found;
  }
  for (int d = 0; d < links_.directions(); ++d) {
    const bool back = !of.up[at(d)];
    for (const int one : {links_.next(d, back, cell), links_.cut_beyond(d, back, cell)})
      if (one >= 0) found.push_back(one);
  }
  return found;
}

/// Puts every cell after the cells upstream of it, except where they wait for each other in a ring. Cells
/// that are ready keep their order.
void octant_sweep::wait_for_cut_cells(octant& of) const {
  const std::vector<int> before = of.order;
  of.place.assign(at(space_.mesh().size()), -1);
  for (std::size_t k = 0; k < before.size(); ++k) of.place[at(before[k])] = static_cast<int>(k);
  std::vector<std::vector<int>> downstream(before.size());
  std::vector<int> waits(before.size(), 0);
  for (std::size_t k = 0; k < before.size(); ++k)
    for (const int cell : upstream_of(of, before[k])) {
      downstream[at(of.place[at(cell)])].push_back(static_cast<int>(k));
      ++waits[k];
    }
  std::priority_queue<int, std::vector<int>, std::greater<>> ready;
  std::vector<bool> taken(before.size(), false);
  for (std::size_t k = 0; k < before.size(); ++k)
    if (waits[k] == 0) ready.push(static_cast<int>(k));
  of.order.clear();
  std::size_t first = 0;
  while (of.order.size() < before.size()) {
    if (ready.empty()) {  // a ring: its first cell does not wait
      while (taken[first]) ++first;
      ready.push(static_cast<int>(first));
    }
    const std::size_t k = at(ready.top());
    ready.pop();
    if (taken[k]) continue;
    taken[k] = true;
    of.order.push_back(before[k]);
    for (const int next : downstream[k])
      if (--waits[at(next)] == 0) ready.push(next);
  }
  for (std::size_t k = 0; k < of.order.size(); ++k) of.place[at(of.order[k])] = static_cast<int>(k);
}

void octant_sweep::pass_cut(const octant& of, int group, std::span<const sweep_rows::strip> strips,
                            double rate, field& r) const {
  const group_of_cut& here = cut_.groups()[at(group)];
  const int directions = links_.directions();
  std::array<const double*, 3> speeds{};
  for (int d = 0; d < directions; ++d) speeds[at(d)] = equation_.speeds(d).data();
  double* row = r.row(here.cell);
  // The rows that enter, for each way; null for cells that come later or belong to other processes.
  std::vector<const double*> from;
  for (std::size_t w = 0; w < here.ways.size(); ++w) {
    const way_out_of_cut& way = here.ways[w];
    if (way.is_end())
      from.push_back(entering_cut_.row(end_of_way_[at(group)][w]));
    else
      from.push_back(way.other >= 0 && !way.is_image && of.place[at(way.other)] < of.place[at(here.cell)]
                         ? r.row(way.other)
                         : nullptr);
  }
  const sweep_rows::rotation turn = rotation_in(here.cell);
  for (const sweep_rows::strip& some : strips)
    for (int k = some.begin; k < some.end; ++k) {
      double sum = row[k], factor = rate;
      if (turn.out != nullptr) {
        sum += turn.in[k] * turn.per_radius * row[k + some.upstream];
        factor += turn.out[k] * turn.per_radius;
      }
      for (std::size_t w = 0; w < here.ways.size(); ++w) {
        const way_out_of_cut& way = here.ways[w];
        double outward = 0.0;
        for (int d = 0; d < directions; ++d) outward += way.normal[at(d)] * speeds[at(d)][k];
        const double copied = way.end ? way.end->copied : 0.0;
        if (outward > 0.0)
          factor += way.rate * outward;
        else if (copied != 0.0)
          factor += way.rate * outward * copied;  // it changes with the row
        else if (from[w] != nullptr)
          sum -= way.rate * outward * from[w][k];
      }
      row[k] = factor > 0.0 ? sum / factor : sum;
    }
}

}  // namespace apsis
