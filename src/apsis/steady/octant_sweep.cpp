#include <apsis/steady/octant_sweep.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/steady/end_response.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>

namespace apsis {
namespace {

/// Returns n · number / parts.
int share_of(int n, int number, int parts) {
  return static_cast<int>(std::int64_t{n} * number / parts);
}

}  // namespace

struct octant_sweep::scratch {
  struct rows {
    std::unique_ptr<end_response> response;
    std::unique_ptr<wall_response> wall;
    aligned_vector<double> state, base, changed;
  };
  per_thread<rows> of_threads;
};

octant_sweep::octant_sweep(const relaxation_model& equation, const domain& space, const cell_links& links,
                           const cut_links& cut, double slope, const ring_turn* turn)
    : equation_(equation),
      space_(space),
      links_(links),
      cut_(cut),
      slope_(slope),
      entering_(static_cast<int>(links.ends().size()), equation.components()),
      scratch_(std::make_unique<scratch>()) {
  for (int group = 0; group < static_cast<int>(cut.groups().size()); ++group) {
    std::vector<int>& ends = end_of_way_.emplace_back();
    const auto& ways = cut.groups()[at(group)].ways;
    for (int way = 0; way < static_cast<int>(ways.size()); ++way) {
      ends.push_back(ways[at(way)].is_end() ? static_cast<int>(cut_ends_.size()) : -1);
      if (ends.back() >= 0) cut_ends_.push_back({group, way});
    }
  }
  entering_cut_ = field(static_cast<int>(cut_ends_.size()), equation.components());
  const int components = equation.components(), directions = links.directions();
  std::vector<std::array<bool, 3>> signs(at(components));
  for (int k = 0; k < components; ++k)
    for (int d = 0; d < directions; ++d) signs[at(k)][at(d)] = equation.speeds(d)[at(k)] > 0.0;
  add_strips(signs, turn);
  for (octant& of : octants_) set_order(of);
  for (int d = 0; d < directions; ++d)
    for (const double v : equation.speeds(d))
      per_cell_[at(d)].push_back(std::abs(v) / space.mesh().spacing(d));
}

octant_sweep::~octant_sweep() = default;

/// Divides the components into octants with strips of equal signs. A strip of a rotation has one angle.
void octant_sweep::add_strips(const std::vector<std::array<bool, 3>>& signs, const ring_turn* turn) {
  std::map<std::array<bool, 3>, octant> found;
  const int apart = turn != nullptr ? turn->layout().apart : static_cast<int>(signs.size());
  for (int k = 0; k < static_cast<int>(signs.size()); ++k) {
    octant& of = found[signs[at(k)]];
    of.up = signs[at(k)];
    if (k % apart > 0 && signs[at(k)] == signs[at(k - 1)])
      of.strips.back().end = k + 1;
    else
      of.strips.push_back({k, k + 1, turn != nullptr ? turn->upstream(at(k)) : 0});
  }
  for (auto& [up, of] : found) octants_.push_back(std::move(of));
  if (turn == nullptr) return;
  size_of_ring_ = turn->size_of_ring();
  for (std::size_t k = 0; k < signs.size(); ++k) {
    const double rate = turn->speed_of(k / size_of_ring_) / turn->width();
    turns_out_.push_back(rate * turn->outflow(k));
    turns_in_.push_back(rate * turn->inflow(k));
  }
  // Strips of a ring, from ω = π to 0 in each half.
  const auto ring = [&](const sweep_rows::strip& one) { return at(one.begin) / size_of_ring_; };
  const auto from_end = [&](const sweep_rows::strip& one) {
    return one.upstream > 0 ? -one.begin : one.begin;
  };
  for (octant& of : octants_)
    std::sort(of.strips.begin(), of.strips.end(), [&](const auto& a, const auto& b) {
      return ring(a) != ring(b) ? ring(a) < ring(b) : from_end(a) < from_end(b);
    });
}

/// Sorts the cells by their numbers, but downwards along every direction with negative velocities.
void octant_sweep::set_order(octant& of) const {
  const grid& mesh = space_.mesh();
  const auto key = [&](int cell) {
    std::array<int, 3> index{};
    for (int d = 0; d < mesh.dimensions(); ++d) {
      const int along = cell / mesh.stride(d) % mesh.cells(d);
      index[at(d)] = of.up[at(d)] ? along : mesh.cells(d) - 1 - along;
    }
    return index;
  };
  of.order = links_.cells();
  std::sort(of.order.begin(), of.order.end(), [&](int a, int b) { return key(a) < key(b); });
  if (!cut_.groups().empty()) wait_for_cut_cells(of);
}

void octant_sweep::solve(const field& f, const std::vector<double>& rates, field& r) {
  const int stride = r.stride();
  scratch_->of_threads.prepare([&](scratch::rows& own) {
    if (own.response) return;
    own.response = std::make_unique<end_response>(space_.space(), stride);
    own.wall = std::make_unique<wall_response>(space_.space().velocities, stride);
    for (auto* row : {&own.state, &own.base, &own.changed}) row->assign(at(stride), 0.0);
  });
  for (const octant& of : octants_) {
    respond(of, f, r);
    respond_at_walls(of, f, r);
    const int threads = threads_here();
    parallel_for(threads, [&](int k) { pass(of, part(of, k, threads), rates, r); });
  }
}

/// Adds the changes that arrive at a place from the octants before `one` to a row. Returns true if
/// there are any.
template <class Arrives>
bool octant_sweep::add_changes_before(const octant& one, const Arrives& arrives, const double* changes,
                                      double* row) const {
  bool any = false;
  for (const octant* before = octants_.data(); before != &one; ++before) {
    if (!arrives(*before)) continue;
    for (const sweep_rows::strip& some : before->strips)
      for (int k = some.begin; k < some.end; ++k) row[k] += changes[k];
    any = true;
  }
  return any;
}

/// Computes the changes that enter at the ends where this octant begins, from those that arrived there
/// in earlier octants.
void octant_sweep::respond(const octant& of, const field& f, const field& delta) {
  constexpr int ends_at_once = 4;
  parallel_blocks(static_cast<int>(links_.ends().size()), ends_at_once, [&](int begin, int end) {
    scratch::rows& own = scratch_->of_threads.here();
    for (int n = begin; n < end; ++n) {
      const auto& here = links_.ends()[at(n)];
      if (here.where.upper == of.up[at(here.where.direction)]) continue;
      double* row = entering_.row(n);
      std::fill_n(row, equation_.components(), 0.0);
      const double *state = f.row(here.cells[0]), *changes = delta.row(here.cells[0]);
      std::copy_n(state, equation_.components(), own.state.begin());
      const auto arrives = [&](const octant& other) {
        return here.where.upper == other.up[at(here.where.direction)];
      };
      if (!add_changes_before(of, arrives, changes, own.state.data())) continue;
      own.response->values_at(here, state, own.base.data());
      own.response->values_at(here, own.state.data(), own.changed.data());
      for (int k = 0; k < equation_.components(); ++k) row[k] = own.changed[at(k)] - own.base[at(k)];
    }
  });
}

/// Computes the changes that enter cut cells at walls and ends, from those that arrived there
/// in earlier octants.
void octant_sweep::respond_at_walls(const octant& of, const field& f, const field& delta) {
  const int components = equation_.components();
  constexpr int ends_at_once = 4;
  parallel_blocks(static_cast<int>(cut_ends_.size()), ends_at_once, [&](int begin, int end) {
    scratch::rows& own = scratch_->of_threads.here();
    for (int n = begin; n < end; ++n) {
      const group_of_cut& group = cut_.groups()[at(cut_ends_[at(n)].group)];
      const way_out_of_cut& way = group.ways[at(cut_ends_[at(n)].way)];
      double* row = entering_cut_.row(n);
      std::fill_n(row, components, 0.0);
      const double *state = f.row(group.cell), *changes = delta.row(group.cell);
      std::copy_n(state, components, own.state.begin());
      // At a wall, changes of any octant may arrive.
      const auto arrives = [&](const octant& other) {
        return !way.end || way.end->where.upper == other.up[at(way.end->where.direction)];
      };
      if (!add_changes_before(of, arrives, changes, own.state.data())) continue;
      const auto values = [&](const double* inside, double* to) {
        if (way.wall != nullptr)
          own.wall->values_at(way, inside, to);
        else
          own.response->values_at(*way.end, inside, to);
      };
      values(state, own.base.data());
      values(own.state.data(), own.changed.data());
      for (int k = 0; k < components; ++k) row[k] = own.changed[at(k)] - own.base[at(k)];
    }
  });
}

/// Returns the strips of the components in part `number` of `parts` equal parts.
std::vector<sweep_rows::strip> octant_sweep::octant::part(int number, int parts) const {
  int all = 0;
  for (const auto& some : strips) all += some.end - some.begin;
  // Positions relative to the current strip.
  int begin = share_of(all, number, parts), end = share_of(all, number + 1, parts);
  std::vector<sweep_rows::strip> found;
  for (const auto& some : strips) {
    const int length = some.end - some.begin;
    if (begin < length && end > 0)
      found.push_back({some.begin + std::max(begin, 0), some.begin + std::min(end, length)});
    begin -= length;
    end -= length;
  }
  return found;
}

/// Returns the strips of all rings from `first` on and before `end`.
std::vector<sweep_rows::strip> octant_sweep::octant::rings(int first, int end,
                                                           std::size_t size_of_ring) const {
  std::vector<sweep_rows::strip> found;
  for (const auto& some : strips) {
    const int ring = some.begin / static_cast<int>(size_of_ring);
    if (ring >= first && ring < end) found.push_back(some);
  }
  return found;
}

/// Returns the strips of part `number` of `parts`, which depend on no other part.
std::vector<sweep_rows::strip> octant_sweep::part(const octant& of, int number, int parts) const {
  if (size_of_ring_ == 0) return of.part(number, parts);
  const int rings = equation_.components() / static_cast<int>(size_of_ring_);
  return of.rings(share_of(rings, number, parts), share_of(rings, number + 1, parts), size_of_ring_);
}

sweep_rows::rotation octant_sweep::rotation_in(int cell) const {
  if (size_of_ring_ == 0) return {};
  const auto radial = at(links_.directions() - 1);
  return {turns_out_.data(), turns_in_.data(), 1.0 / space_.mesh().centre(cell)[radial]};
}

void octant_sweep::pass(const octant& of, std::span<const sweep_rows::strip> strips,
                        const std::vector<double>& rates, field& r) const {
  const int directions = links_.directions();
  std::array<const double*, 3> lambda{};
  for (int d = 0; d < directions; ++d) lambda[at(d)] = per_cell_[at(d)].data();
  for (const int cell : of.order) {
    std::array<sweep_rows::upstream, 3> terms;
    double* row = r.row(cell);
    if (const int group = cut_.group_of(cell); group >= 0) {
      pass_cut(of, group, strips, rates[at(cell)], r);
      continue;
    }
    for (int d = 0; d < directions; ++d) terms[at(d)] = terms_of(of, cell, d, r);
    sweep_rows::solve({terms.data(), at(directions)}, lambda, rates[at(cell)], rotation_in(cell), strips,
                      row);
  }
}

/// Returns the number of the end at the axis next to a cell; −1 elsewhere.
int octant_sweep::axis_next_to(int direction, bool upper, int cell) const {
  const int end = links_.end_next_to(direction, upper, cell);
  return end >= 0 && links_.ends()[at(end)].side->is_axis() ? end : -1;
}

/// Returns the upwind terms of a cell along one direction, for the signs of the velocities of the octant.
sweep_rows::upstream octant_sweep::terms_of(const octant& of, int cell, int direction, const field& r) const {
  sweep_rows::upstream from;
  const bool up = of.up[at(direction)];
  int one = links_.next(direction, !up, cell);
  // Slopes use only whole cells: a cut cell upstream counts as the beginning of the gas.
  const int cut = one < 0 ? links_.cut_beyond(direction, !up, cell) : -1;
  if (cut >= 0 && of.place[at(cut)] < of.place[at(cell)]) one = cut;
  if (one < 0) {
    const int end = links_.end_next_to(direction, !up, cell);
    // The entering row copies this row and changes with it, so that no difference enters. A change of 0 would
    // fix the row if few collisions change it.
    const double copied = end >= 0 ? links_.ends()[at(end)].copied : 0.0;
    const bool enters = end >= 0 && copied == 0.0;
    from.one = from.two = enters ? entering_.row(end) : r.row(cell);
    from.here = 1.0 - copied;
    from.first = enters ? 1.0 : 0.0;
    return from;
  }
  const int two = one == cut ? -1 : links_.next(direction, !up, one);
  const int axis = two < 0 && one != cut ? axis_next_to(direction, !up, one) : -1;
  from.here = 1.0 + slope_;
  from.one = r.row(one);
  from.two = axis >= 0 ? entering_.row(axis) : two < 0 ? from.one : r.row(two);
  const bool has_two = two >= 0 || axis >= 0;
  from.first = has_two ? 1.0 + 2.0 * slope_ : 1.0 + slope_;
  from.second = has_two ? -slope_ : 0.0;
  return from;
}

}  // namespace apsis
