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
    aligned_vector<double> state, base, changed;
  };
  per_thread<rows> of_threads;
};

octant_sweep::octant_sweep(const relaxation_model& equation, const domain& space, const cell_links& links,
                           double slope)
    : equation_(equation),
      space_(space),
      links_(links),
      slope_(slope),
      entering_(static_cast<int>(links.ends().size()), equation.components()),
      scratch_(std::make_unique<scratch>()) {
  const int components = equation.components(), directions = links.directions();
  std::map<std::array<bool, 3>, octant> found;
  std::array<bool, 3> last{};
  for (int k = 0; k < components; ++k) {
    std::array<bool, 3> up{};
    for (int d = 0; d < directions; ++d) up[at(d)] = equation.speeds(d)[at(k)] > 0.0;
    octant& of = found[up];
    of.up = up;
    if (k > 0 && up == last)
      of.strips.back().end = k + 1;
    else
      of.strips.push_back({k, k + 1});
    last = up;
  }
  for (auto& [up, of] : found) {
    set_order(of);
    octants_.push_back(std::move(of));
  }
  for (int d = 0; d < directions; ++d)
    for (const double v : equation.speeds(d))
      per_cell_[at(d)].push_back(std::abs(v) / space.mesh().spacing(d));
}

octant_sweep::~octant_sweep() = default;

/// Cells in the order of their numbers, every direction by itself forwards or backwards.
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
}

void octant_sweep::solve(const field& f, const std::vector<double>& rates, field& r) {
  const int stride = r.stride();
  scratch_->of_threads.prepare([&](scratch::rows& own) {
    if (own.response) return;
    own.response = std::make_unique<end_response>(space_.space(), stride);
    for (auto* row : {&own.state, &own.base, &own.changed}) row->assign(at(stride), 0.0);
  });
  for (const octant& of : octants_) {
    respond(of, f, r);
    const int threads = threads_here();
    parallel_for(threads, [&](int k) { pass(of, of.part(k, threads), rates, r); });
  }
}

/// Sets the changes that enter at the ends where this octant begins, from those that arrived there in the
/// octants before it.
void octant_sweep::respond(const octant& of, const field& f, const field& delta) {
  const auto begun = static_cast<std::size_t>(&of - octants_.data());
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
      bool any = false;
      for (std::size_t before = 0; before < begun; ++before) {
        const octant& other = octants_[before];
        if (here.where.upper != other.up[at(here.where.direction)]) continue;
        for (const sweep_rows::strip& some : other.strips)
          for (int k = some.begin; k < some.end; ++k) own.state[at(k)] += changes[k];
        any = true;
      }
      if (!any) continue;
      own.response->values_at(here, state, own.base.data());
      own.response->values_at(here, own.state.data(), own.changed.data());
      for (int k = 0; k < equation_.components(); ++k) row[k] = own.changed[at(k)] - own.base[at(k)];
    }
  });
}

/// Returns the strips with the components of one of so many equal parts.
std::vector<sweep_rows::strip> octant_sweep::octant::part(int number, int parts) const {
  int all = 0;
  for (const auto& some : strips) all += some.end - some.begin;
  // Relative to the next strip.
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

void octant_sweep::pass(const octant& of, std::span<const sweep_rows::strip> strips,
                        const std::vector<double>& rates, field& r) const {
  const int directions = links_.directions();
  std::array<const double*, 3> lambda{};
  for (int d = 0; d < directions; ++d) lambda[at(d)] = per_cell_[at(d)].data();
  for (const int cell : of.order) {
    std::array<sweep_rows::upstream, 3> terms;
    double* row = r.row(cell);
    for (int d = 0; d < directions; ++d) terms[at(d)] = terms_of(cell, d, of.up[at(d)], r);
    sweep_rows::solve({terms.data(), at(directions)}, lambda, rates[at(cell)], strips, row);
  }
}

/// The terms of a cell along one direction, for velocities that are positive or negative.
sweep_rows::upstream octant_sweep::terms_of(int cell, int direction, bool up, const field& r) const {
  sweep_rows::upstream from;
  const int one = links_.next(direction, !up, cell);
  if (one < 0) {
    const int end = links_.end_next_to(direction, !up, cell);
    // A copy of this row changes with it: no difference enters. A change of 0 would hold the row where few
    // collisions change it.
    const bool copies = end >= 0 && links_.ends()[at(end)].copies;
    from.one = from.two = end < 0 || copies ? r.row(cell) : entering_.row(end);
    from.here = copies ? 0.0 : 1.0;
    from.first = end < 0 || copies ? 0.0 : 1.0;
    return from;
  }
  const int two = links_.next(direction, !up, one);
  from.here = 1.0 + slope_;
  from.one = r.row(one);
  from.first = two < 0 ? 1.0 + slope_ : 1.0 + 2.0 * slope_;
  from.two = two < 0 ? from.one : r.row(two);
  from.second = two < 0 ? 0.0 : -slope_;
  return from;
}

}  // namespace apsis
