#include <apsis/steady/macroscopic_system.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/steady/dissection.hpp>
#include <apsis/steady/end_response.hpp>
#include <apsis/steady/tangent_rows.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Dense>
#include <Eigen/SparseLU>

namespace apsis {
namespace {

/// Cells and their weights in the value at an edge.
struct weighted_cells {
  std::array<std::pair<int, double>, 5> terms{};
  int count = 0;

  void add(int cell, double weight) {
    for (int k = 0; k < count; ++k)
      if (terms[at(k)].first == cell) {
        terms[at(k)].second += weight;
        return;
      }
    terms[at(count++)] = {cell, weight};
  }
  const auto* begin() const { return terms.data(); }
  const auto* end() const { return terms.data() + count; }
};

/// Adds the cell next to `cell`, or beyond the gas its value on the parabola through three cells inside, or
/// the line or the constant where there are fewer.
void add_neighbour(const cell_links& links, int direction, bool upper, int cell, double weight,
                   weighted_cells& to) {
  if (const int other = links.next_or_image(direction, upper, cell); other >= 0) return to.add(other, weight);
  const int second = links.next(direction, !upper, cell),
            third = second < 0 ? -1 : links.next(direction, !upper, second);
  if (third >= 0) {
    to.add(cell, 3.0 * weight);
    to.add(second, -3.0 * weight);
    to.add(third, weight);
  } else if (second >= 0) {
    to.add(cell, 2.0 * weight);
    to.add(second, -weight);
  } else {
    to.add(cell, weight);
  }
}

/// The value at the upper or lower edge of a cell, of what moves towards it.
weighted_cells edge_of(const cell_links& links, int direction, bool upper, int cell, bool first_order) {
  weighted_cells found;
  if (first_order) {
    found.add(cell, 1.0);
    return found;
  }
  found.add(cell, 5.0 / 6.0);
  add_neighbour(links, direction, upper, cell, 1.0 / 3.0, found);
  add_neighbour(links, direction, !upper, cell, -1.0 / 6.0, found);
  return found;
}

}  // namespace

/// J_of_cell[direction] = {A⁺, A⁻, D}; J of an end: the derivative of the flux towards larger coordinates.
struct macroscopic_system::matrices {
  std::vector<double> of_cells, of_ends, of_sources;
  /// The order of the cells is one of little fill already.
  Eigen::SparseLU<Eigen::SparseMatrix<double>, Eigen::NaturalOrdering<int>> factors;
};

struct macroscopic_system::assembly {
  int count;
  std::vector<Eigen::Triplet<double>> terms = {};

  /// Adds factor · matrix to a block of J.
  void add(int row, int column, double factor, const double* matrix) {
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j)
        if (const double x = matrix[i * count + j]; x != 0.0)
          terms.emplace_back(row * count + i, column * count + j, factor * x);
  }
};

macroscopic_system::macroscopic_system(const relaxation_model& equation, const domain& space,
                                       const cell_links& links, inside acts, bool first_order)
    : equation_(equation),
      space_(space),
      links_(links),
      acts_(std::move(acts)),
      first_order_(first_order),
      count_(equation.moment_count()),
      number_(at(space.mesh().size()), -1),
      conserved_(at(count_), false),
      matrices_(std::make_unique<matrices>()) {
  std::array<bool, 3> periodic{};
  for (int d = 0; d < space.mesh().dimensions(); ++d) periodic[at(d)] = space.periodic(d);
  int number = 0;
  for (const int cell : dissected_cells(space.mesh(), periodic)) number_[at(cell)] = number++;
}

macroscopic_system::~macroscopic_system() = default;

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
  aligned_vector<double> base, changed;
  std::vector<double> flux;

  scratch_of_cells(const relaxation_model& equation, const domain& space)
      : tangents(equation),
        response(space.space(), field(1, equation.components()).stride()),
        base(at(equation.components())),
        changed(at(equation.components())),
        flux(at(equation.moment_count())) {}
};

/// Derivative by ω of the flux towards larger coordinates at an end, where what leaves is that of
/// equilibrium.
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

}  // namespace

void macroscopic_system::build(const moments& omega, const std::vector<double>& rates, double pseudo_rate) {
  const int directions = links_.directions(), square = count_ * count_, per_cell = 3 * directions * square;
  matrices_->of_cells.resize(at(space_.mesh().size()) * at(per_cell));
  matrices_->of_ends.resize(links_.ends().size() * at(square));
  if (has_source_of_state()) matrices_->of_sources.resize(at(space_.mesh().size()) * at(square));
  const half_speeds halves(equation_, directions);
  per_thread<std::unique_ptr<scratch_of_cells>> scratch;
  scratch.prepare([&](auto& own) { own = std::make_unique<scratch_of_cells>(equation_, space_); });
  parallel_blocks(static_cast<int>(links_.cells().size()), cells_of_a_block, [&](int begin, int end) {
    scratch_of_cells& own = *scratch.here();
    for (int n = begin; n < end; ++n) {
      const int cell = links_.cells()[at(n)];
      const double* here = omega.data() + at(cell) * at(count_);
      if (!own.tangents.move_to(here))
        throw numerical_error(equation_.why_inadmissible(here), {.cell = cell, .value = here[0]});
      if (has_source_of_state())
        differentiate_source(cell, own.tangents, matrices_->of_sources.data() + at(cell) * at(square));
      double* to = matrices_->of_cells.data() + at(cell) * at(per_cell);
      for (int d = 0; d < directions; ++d, to += 3 * square) {
        own.tangents.moments_of_weighted(halves.up[at(d)], to);
        own.tangents.moments_of_weighted(halves.down[at(d)], to + square);
        own.tangents.moments_of_deviation(equation_.speeds(d), to + 2 * square);
        for (int k = 0; k < square; ++k) to[2 * square + k] /= rates[at(cell)];
        for (const bool upper : {false, true})
          if (const int number = links_.end_next_to(d, upper, cell); number >= 0)
            differentiate_end(equation_, links_.ends()[at(number)], own,
                              matrices_->of_ends.data() + at(number) * at(square));
      }
    }
  });
  assembly all{count_};
  for (int d = 0; d < directions; ++d) add_faces(all, d);
  add_forces(all);
  for (const int cell : links_.cells())
    if (has_source_of_state())
      all.add(number_[at(cell)], number_[at(cell)], -1.0,
              matrices_->of_sources.data() + at(cell) * at(square));
  const int unknowns = static_cast<int>(links_.cells().size()) * count_;
  add_constraints(all);
  if (pseudo_rate > 0.0)
    for (int k = 0; k < unknowns; ++k) all.terms.emplace_back(k, k, pseudo_rate);
  const auto extra = static_cast<int>(std::count(conserved_.begin(), conserved_.end(), true));
  Eigen::SparseMatrix<double> system(unknowns + extra, unknowns + extra);
  system.setFromTriplets(all.terms.begin(), all.terms.end());
  system.makeCompressed();
  // Pivots off the diagonal would undo the order; they are taken where that is a hundred times smaller.
  matrices_->factors.isSymmetric(true);
  matrices_->factors.setPivotThreshold(0.01);
  matrices_->factors.compute(system);
  if (matrices_->factors.info() != Eigen::Success)
    throw numerical_error("the moment equations of the steady state are singular", {});
}

void macroscopic_system::add_faces(assembly& to, int direction) const {
  const int square = count_ * count_;
  const double per_length = 1.0 / space_.mesh().spacing(direction);
  const auto matrix = [&](int cell, int which) {
    return matrices_->of_cells.data() +
           at(square) * (at(cell) * 3 * at(links_.directions()) + 3 * at(direction) + at(which));
  };
  // The flux towards larger coordinates through the face between two cells. One of them may be missing.
  const auto add_flux = [&](int below, int above, int of, double factor, const double* block) {
    if (below >= 0) to.add(number_[at(below)], number_[at(of)], per_length * factor, block);
    if (above >= 0) to.add(number_[at(above)], number_[at(of)], -per_length * factor, block);
  };
  for (const int cell : links_.cells()) {
    const int above = links_.next_or_image(direction, true, cell);
    if (above < 0) continue;
    for (const auto& [of, weight] : edge_of(links_, direction, true, cell, first_order_))
      add_flux(cell, above, of, weight, matrix(of, 0));
    for (const auto& [of, weight] : edge_of(links_, direction, false, above, first_order_))
      add_flux(cell, above, of, weight, matrix(of, 1));
    for (const int of_spread : {cell, above}) {
      add_flux(cell, above, above, -0.5 * per_length, matrix(of_spread, 2));
      add_flux(cell, above, cell, 0.5 * per_length, matrix(of_spread, 2));
    }
  }
  for (std::size_t number = 0; number < links_.ends().size(); ++number) {
    const auto& end = links_.ends()[number];
    if (end.where.direction != direction) continue;
    const bool upper = end.where.upper;
    const int cell = end.cells[0];
    for (const auto& [of, weight] : edge_of(links_, direction, upper, cell, first_order_))
      add_flux(upper ? cell : -1, upper ? -1 : cell, of, weight,
               matrices_->of_ends.data() + number * at(square));
  }
}

/// A force a gives the momentum ρa and the energy ρu·a per unit of time.
void macroscopic_system::add_forces(assembly& to) const {
  const gas_model* gas = equation_.as_gas();
  if (!acts_.force || gas == nullptr) return;
  const int energy = count_ - 1;
  for (const int cell : links_.cells()) {
    const auto a = acts_.force->value(0.0, space_.mesh().centre(cell));
    const int first = number_[at(cell)] * count_;
    for (int k = 0; k < gas->molecules().dimensions(); ++k) {
      if (a[at(k)] == 0.0) continue;
      to.terms.emplace_back(first + 1 + k, first, -a[at(k)]);
      to.terms.emplace_back(first + energy, first + 1 + k, -a[at(k)]);
    }
  }
}

bool macroscopic_system::has_source_of_state() const {
  return equation_.has_source() || (acts_.source && acts_.source->growth);
}

/// matrix ← ℛ ∂S/∂ω of equilibrium.
void macroscopic_system::differentiate_source(int cell, tangent_rows& tangents, double* matrix) const {
  const auto components = at(equation_.components());
  std::vector<double> base(components), changed(components), own(components), column(at(count_));
  const auto evaluate = [&](const double* row, std::vector<double>& to) {
    std::fill(to.begin(), to.end(), 0.0);
    if (acts_.source && acts_.source->growth)
      acts_.source->value(0.0, space_.mesh().centre(cell), {row, components}, to);
    if (!equation_.has_source()) return;
    equation_.source(row, own.data());
    for (std::size_t k = 0; k < components; ++k) to[k] += own[k];
  };
  evaluate(tangents.equilibrium(), base);
  for (int j = 0; j < count_; ++j) {
    evaluate(tangents.changed(j), changed);
    for (std::size_t k = 0; k < components; ++k) changed[k] = (changed[k] - base[k]) / tangents.step(j);
    equation_.moments(changed.data(), column.data());
    for (int i = 0; i < count_; ++i) matrix[i * count_ + j] = column[at(i)];
  }
}

void macroscopic_system::add_constraints(assembly& to) {
  const int cells = static_cast<int>(links_.cells().size()), unknowns = cells * count_;
  std::vector<double> sums(at(count_) * at(unknowns), 0.0), sizes(at(count_), 0.0);
  for (const auto& term : to.terms) {
    const std::size_t moment = at(term.row() % count_);
    sums[moment * at(unknowns) + at(term.col())] += term.value();
    sizes[moment] = std::max(sizes[moment], std::abs(term.value()));
  }
  // Fluxes between cells cancel to rounding, those at ends to half the digits, which differences of rows
  // have.
  constexpr double rounding = 1e-7;
  int extra = unknowns;
  for (std::size_t moment = 0; moment < at(count_); ++moment) {
    const auto first = sums.begin() + static_cast<std::ptrdiff_t>(moment) * unknowns;
    const double largest = std::abs(*std::max_element(
        first, first + unknowns, [](double a, double b) { return std::abs(a) < std::abs(b); }));
    conserved_[moment] = largest <= rounding * sizes[moment];
    if (!conserved_[moment]) continue;
    for (int cell = 0; cell < cells; ++cell) {
      to.terms.emplace_back(cell * count_ + static_cast<int>(moment), extra, 1.0);
      to.terms.emplace_back(extra, cell * count_ + static_cast<int>(moment), 1.0 / cells);
    }
    ++extra;
  }
}

macroscopic_system::moments macroscopic_system::solve(const moments& r,
                                                      const std::vector<double>& missing) const {
  const int unknowns = static_cast<int>(links_.cells().size()) * count_;
  const auto extra = static_cast<int>(std::count(conserved_.begin(), conserved_.end(), true));
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns + extra);
  for (const int cell : links_.cells())
    for (int i = 0; i < count_; ++i) right[number_[at(cell)] * count_ + i] = r[at(cell) * at(count_) + at(i)];
  int next = unknowns;
  for (std::size_t moment = 0; moment < at(count_); ++moment)
    if (conserved_[moment]) right[next++] = missing[moment] / static_cast<double>(links_.cells().size());
  const Eigen::VectorXd found = matrices_->factors.solve(right);
  moments change(r.size(), 0.0);
  for (const int cell : links_.cells())
    for (int i = 0; i < count_; ++i)
      change[at(cell) * at(count_) + at(i)] = found[number_[at(cell)] * count_ + i];
  return change;
}

}  // namespace apsis
