#include <apsis/steady/octant_sweep.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/steady/end_response.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

namespace apsis {
namespace {

constexpr int longest_strip = 64;
/// Share of the slope in the value at an edge: between first order and the scheme of second order, ½.
constexpr double slope = 0.25;

/// The terms of one direction: upstream values and their factors, relative to |v|/Δx.
struct upstream {
  double here = 1.0, first = 0.0, second = 0.0;
  const double *one = nullptr, *two = nullptr;
};

/// row ← δ of a cell, for components begin … end−1.
template <std::size_t directions>
void advance_row(const std::array<upstream, 3>& terms, const std::array<const double*, 3>& speeds,
                 double rate, int begin, int end, double* row) {
  // Copies of what does not change: the compiler cannot know that the row is not among them.
  std::array<upstream, directions> from;
  std::array<const double*, directions> speed;
  for (std::size_t d = 0; d < directions; ++d) {
    from[d] = terms[d];
    speed[d] = speeds[d];
  }
#pragma omp simd
  for (int k = begin; k < end; ++k) {
    double sum = row[k], factor = rate;
    for (std::size_t d = 0; d < directions; ++d) {
      sum += speed[d][k] * (from[d].first * from[d].one[k] + from[d].second * from[d].two[k]);
      factor += speed[d][k] * from[d].here;
    }
    row[k] = sum / factor;
  }
}

}  // namespace

struct octant_sweep::scratch {
  struct rows {
    std::unique_ptr<end_response> response;
    aligned_vector<double> state, base, changed;
  };
  per_thread<rows> of_threads;
};

octant_sweep::octant_sweep(const relaxation_model& equation, const domain& space, const cell_links& links)
    : equation_(equation),
      space_(space),
      links_(links),
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
    const bool goes_on =
        k > 0 && up == last && of.strips.back().end == k && k - of.strips.back().begin < longest_strip;
    if (goes_on)
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
    parallel_for(static_cast<int>(of.strips.size()), [&](int k) { pass(of, of.strips[at(k)], rates, r); });
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
        for (const strip& some : other.strips)
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

void octant_sweep::pass(const octant& of, const strip& components, const std::vector<double>& rates,
                        field& r) const {
  const int directions = links_.directions();
  std::array<const double*, 3> speeds{};
  for (int d = 0; d < directions; ++d) speeds[at(d)] = per_cell_[at(d)].data();
  for (const int cell : of.order) {
    std::array<upstream, 3> terms;
    double* row = r.row(cell);
    for (int d = 0; d < directions; ++d) {
      upstream& from = terms[at(d)];
      const bool lower = of.up[at(d)];
      const int one = links_.next(d, !lower, cell);
      const int two = one < 0 ? -1 : links_.next(d, !lower, one);
      if (one < 0) {
        const int end = links_.end_next_to(d, !lower, cell);
        // A copy of this row changes with it: no difference enters. A change of 0 would hold the row where
        // few collisions change it.
        const bool copies = end >= 0 && links_.ends()[at(end)].copies;
        from.one = end < 0 || copies ? row : entering_.row(end);
        from.two = from.one;
        from.here = copies ? 0.0 : 1.0;
        from.first = end < 0 || copies ? 0.0 : 1.0;
        continue;
      }
      from.here = 1.0 + slope;
      from.one = r.row(one);
      from.first = two < 0 ? 1.0 + slope : 1.0 + 2.0 * slope;
      from.two = two < 0 ? from.one : r.row(two);
      from.second = two < 0 ? 0.0 : -slope;
    }
    const auto advance = directions == 1   ? &advance_row<1>
                         : directions == 2 ? &advance_row<2>
                                           : &advance_row<3>;
    advance(terms, speeds, rates[at(cell)], components.begin, components.end, row);
  }
}

}  // namespace apsis
