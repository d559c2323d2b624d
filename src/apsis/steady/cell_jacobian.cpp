#include <apsis/steady/cell_jacobian.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/steady/end_response.hpp>
#include <apsis/steady/tangent_rows.hpp>

#include <algorithm>
#include <array>
#include <memory>

namespace apsis {
namespace {

/// Positive and negative parts of the speeds along every direction.
struct half_speeds {
  std::array<std::vector<double>, 3> up, down;

  half_speeds(const model& equation, int directions) {
    for (int d = 0; d < directions; ++d)
      for (const double v : equation.speeds(d)) {
        up[at(d)].push_back(std::max(v, 0.0));
        down[at(d)].push_back(std::min(v, 0.0));
      }
  }
};

struct scratch_of_cells {
  tangent_rows tangents;
  end_response response;
  wall_response wall;
  aligned_vector<double> base, changed;
  std::vector<double> flux;

  scratch_of_cells(const relaxation_model& equation, const domain& space)
      : tangents(equation),
        response(space.space(), field::padded(equation.components())),
        wall(space.space().velocities, field::padded(equation.components())),
        base(at(equation.components())),
        changed(at(equation.components())),
        flux(at(equation.moment_count())) {}
};

/// Computes the derivative with respect to ω of the flux towards larger coordinates at an end. Leaving
/// components are in equilibrium.
void differentiate_end(const relaxation_model& equation, const gas_end_of_segment& end,
                       scratch_of_cells& with, double* matrix) {
  const int count = equation.moment_count();
  const auto speeds = equation.speeds(end.where.direction);
  with.response.values_at(end, with.tangents.equilibrium(), with.base.data());
  for (int j = 0; j < count; ++j) {
    with.response.values_at(end, with.tangents.changed(j), with.changed.data());
    for (std::size_t k = 0; k < speeds.size(); ++k)
      with.changed[k] = speeds[k] * ((with.changed[k] - with.base[k]) / with.tangents.step(j));
    equation.moments(with.changed.data(), with.flux.data());
    for (int i = 0; i < count; ++i) matrix[i * count + j] = with.flux[at(i)];
  }
}

/// Adds the derivative with respect to ω of the flux out of a cut cell at a wall or end, divided by the
/// volume of its gas.
void differentiate_way(const relaxation_model& equation, const way_out_of_cut& way,
                       const jacobian_layout& layout, scratch_of_cells& with, double* blocks) {
  const int count = equation.moment_count(), directions = layout.directions;
  const auto values = [&](const double* inside, double* row) {
    if (way.wall != nullptr)
      with.wall.values_at(way, inside, row);
    else
      with.response.values_at(*way.end, inside, row);
  };
  values(with.tangents.equilibrium(), with.base.data());
  for (int j = 0; j < count; ++j) {
    values(with.tangents.changed(j), with.changed.data());
    for (std::size_t k = 0; k < with.base.size(); ++k) {
      double outward = 0.0;
      for (int d = 0; d < directions; ++d) outward += way.normal[at(d)] * equation.speeds(d)[k];
      with.changed[k] = way.rate * outward * ((with.changed[k] - with.base[k]) / with.tangents.step(j));
    }
    equation.moments(with.changed.data(), with.flux.data());
    for (int weight = 0; weight <= directions; ++weight)
      for (int i = 0; i < count; ++i)
        blocks[layout.walls(weight) + at(i * count + j)] +=
            (weight == 0 ? 1.0 : way.from_centre[at(weight - 1)]) * with.flux[at(i)];
  }
}

}  // namespace

cell_jacobian::cell_jacobian(const relaxation_model& equation, const domain& space, const cell_links& links,
                             const cut_links& cut, const inside_domain& acts)
    : equation_(equation),
      space_(space),
      links_(links),
      cut_(cut),
      acts_(acts),
      layout_{links.directions(), equation.moment_count(),
              equation.has_source() || (acts.source && acts.source->growth), acts.turn.has_value()} {}

std::vector<double> cell_jacobian::compute(const std::vector<double>& omega,
                                           const std::vector<double>& rates) const {
  const half_speeds halves(equation_, layout_.directions);
  std::vector<double> all(at(space_.mesh().size()) * at(layout_.numbers()), 0.0);
  per_thread<std::unique_ptr<scratch_of_cells>> scratch;
  scratch.prepare([&](auto& own) { own = std::make_unique<scratch_of_cells>(equation_, space_); });
  parallel_blocks(static_cast<int>(links_.cells().size()), cells_of_a_block, [&](int begin, int end) {
    scratch_of_cells& own = *scratch.here();
    for (int n = begin; n < end; ++n) {
      const int cell = links_.cells()[at(n)];
      const double* here = omega.data() + at(cell) * at(layout_.moments);
      if (!own.tangents.move_to(here))
        throw numerical_error(equation_.why_inadmissible(here),
                              {.cell = space_.number_in_whole_mesh(cell), .value = here[0]});
      double* to = all.data() + at(cell) * at(layout_.numbers());
      if (layout_.source) differentiate_source(cell, own.tangents, to + layout_.of_source());
      if (layout_.turns) differentiate_rotation(cell, rates[at(cell)], own.tangents, to);
      for (int d = 0; d < layout_.directions; ++d) {
        own.tangents.moments_of({.factors = halves.up[at(d)]}, to + layout_.transport(d, true));
        own.tangents.moments_of({.factors = halves.down[at(d)]}, to + layout_.transport(d, false));
        double* deviation = to + layout_.deviation(d);
        const row_map moved{.factors = equation_.speeds(d)};
        own.tangents.moments_of_deviation(moved, moved, deviation);
        for (std::size_t k = 0; k < layout_.square(); ++k) deviation[k] /= rates[at(cell)];
        for (const bool upper : {false, true})
          if (const int number = links_.end_next_to(d, upper, cell);
              number >= 0 && !links_.ends()[at(number)].side->is_axis())  // there F = 0
            differentiate_end(equation_, links_.ends()[at(number)], own, to + layout_.end({d, upper}));
      }
      if (const int group = cut_.group_of(cell); group >= 0)
        for (const way_out_of_cut& way : cut_.groups()[at(group)].ways)
          if (way.is_end() && !(way.end && way.end->side->is_axis()))
            differentiate_way(equation_, way, layout_, own, to);
    }
  });
  return all;
}

void cell_jacobian::differentiate_rotation(int cell, double rate, tangent_rows& tangents,
                                           double* blocks) const {
  const int radial = layout_.radial();
  const row_map turned{.turn = &*acts_.turn, .radius = space_.mesh().centre(cell)[at(radial)]},
      moved{.factors = equation_.speeds(radial)};
  tangents.moments_of(turned, blocks + layout_.turn());
  tangents.moments_of_deviation(turned, turned, blocks + layout_.turned_twice());
  tangents.moments_of_deviation(turned, moved, blocks + layout_.turned_then_moved());
  tangents.moments_of_deviation(moved, turned, blocks + layout_.moved_then_turned());
  for (const std::size_t one :
       {layout_.turned_twice(), layout_.turned_then_moved(), layout_.moved_then_turned()})
    for (std::size_t k = 0; k < layout_.square(); ++k) blocks[one + k] /= rate;
}

void cell_jacobian::differentiate_source(int cell, const tangent_rows& tangents, double* matrix) const {
  const auto components = at(equation_.components());
  const int count = layout_.moments;
  std::vector<double> base(components), changed(components), own(components), column(at(count));
  const auto evaluate = [&](const double* row, std::vector<double>& to) {
    std::fill(to.begin(), to.end(), 0.0);
    if (acts_.source && acts_.source->growth)
      acts_.source->value(0.0, space_.mesh().centre(cell), {row, components}, to);
    if (!equation_.has_source()) return;
    equation_.source(row, own.data());
    for (std::size_t k = 0; k < components; ++k) to[k] += own[k];
  };
  evaluate(tangents.equilibrium(), base);
  for (int j = 0; j < count; ++j) {
    evaluate(tangents.changed(j), changed);
    for (std::size_t k = 0; k < components; ++k) changed[k] = (changed[k] - base[k]) / tangents.step(j);
    equation_.moments(changed.data(), column.data());
    for (int i = 0; i < count; ++i) matrix[i * count + j] = column[at(i)];
  }
}

}  // namespace apsis
