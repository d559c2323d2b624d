#include <apsis/steady/macroscopic_system.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/semidiscrete/gathered_cells.hpp>
#include <apsis/steady/dissection.hpp>
#include <apsis/steady/internal/neutral_mode.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

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

/// J of the whole mesh.
class macroscopic_system::whole_system {
 public:
  whole_system(const relaxation_model& equation, const problem_builder& builder, const inside_domain& acts,
               const jacobian_layout& layout);

  /// `blocks`: of all cells, [cell][layout.numbers()].
  void build(std::span<const double> blocks, double pseudo_rate, bool holds_neutral);
  const std::vector<bool>& conserved() const { return conserved_; }
  bool has_neutral_mode() const { return neutral_.has_value(); }
  moments solve(const moments& r, const std::vector<double>& missing) const;

 private:
  struct assembly;
  void add_faces(assembly& to, std::span<const double> blocks, int direction) const;
  void add_forces(assembly& to) const;
  void add_constraints(assembly& to);
  int unknowns() const { return static_cast<int>(links_.cells().size()) * count_; }
  int constraints() const { return static_cast<int>(std::count(conserved_.begin(), conserved_.end(), true)); }

  const relaxation_model& equation_;
  const domain& space_;
  const inside_domain& acts_;
  jacobian_layout layout_;
  cell_links links_;
  bool first_order_;
  int count_;
  std::vector<int> number_;  ///< of a cell among those of the gas
  std::vector<bool> conserved_;
  /// The order of the cells is one of little fill already.
  sparse_factors factors_;
  std::optional<neutral_mode> neutral_;
};

struct macroscopic_system::whole_system::assembly {
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

macroscopic_system::whole_system::whole_system(const relaxation_model& equation,
                                               const problem_builder& builder, const inside_domain& acts,
                                               const jacobian_layout& layout)
    : equation_(equation),
      space_(builder.whole_space()),
      acts_(acts),
      layout_(layout),
      links_(space_),
      first_order_(builder.first_order()),
      count_(layout.moments),
      number_(at(space_.mesh().size()), -1),
      conserved_(at(count_), false) {
  std::array<bool, 3> periodic{};
  for (int d = 0; d < space_.mesh().dimensions(); ++d) periodic[at(d)] = space_.periodic(d);
  int number = 0;
  for (const int cell : dissected_cells(space_.mesh(), periodic)) number_[at(cell)] = number++;
}

void macroscopic_system::whole_system::build(std::span<const double> blocks, double pseudo_rate,
                                             bool holds_neutral) {
  assembly all{count_};
  for (int d = 0; d < layout_.directions; ++d) add_faces(all, blocks, d);
  add_forces(all);
  for (const int cell : links_.cells())
    if (layout_.source)
      all.add(number_[at(cell)], number_[at(cell)], -1.0,
              blocks.data() + at(cell) * at(layout_.numbers()) + layout_.of_source());
  add_constraints(all);
  if (pseudo_rate > 0.0)
    for (int k = 0; k < unknowns(); ++k) all.terms.emplace_back(k, k, pseudo_rate);
  const int size = unknowns() + constraints();
  Eigen::SparseMatrix<double> system(size, size);
  system.setFromTriplets(all.terms.begin(), all.terms.end());
  system.makeCompressed();
  // Pivots off the diagonal would undo the order; they are taken where that is a hundred times smaller.
  factors_.isSymmetric(true);
  factors_.setPivotThreshold(0.01);
  factors_.compute(system);
  if (factors_.info() != Eigen::Success)
    throw numerical_error("the moment equations of the steady state are singular", {});
  neutral_ = holds_neutral ? find_neutral_mode(factors_) : std::nullopt;
}

void macroscopic_system::whole_system::add_faces(assembly& to, std::span<const double> blocks,
                                                 int direction) const {
  const double per_length = 1.0 / space_.mesh().spacing(direction);
  const auto matrix = [&](int cell, std::size_t place) {
    return blocks.data() + at(cell) * at(layout_.numbers()) + place;
  };
  const std::size_t up = layout_.transport(direction, true), down = layout_.transport(direction, false),
                    deviation = layout_.deviation(direction);
  // The flux towards larger coordinates through the face between two cells. One of them may be missing.
  const auto add_flux = [&](int below, int above, int of, double factor, const double* block) {
    if (below >= 0) to.add(number_[at(below)], number_[at(of)], per_length * factor, block);
    if (above >= 0) to.add(number_[at(above)], number_[at(of)], -per_length * factor, block);
  };
  for (const int cell : links_.cells()) {
    const int above = links_.next_or_image(direction, true, cell);
    if (above < 0) continue;
    for (const auto& [of, weight] : edge_of(links_, direction, true, cell, first_order_))
      add_flux(cell, above, of, weight, matrix(of, up));
    for (const auto& [of, weight] : edge_of(links_, direction, false, above, first_order_))
      add_flux(cell, above, of, weight, matrix(of, down));
    for (const int of_spread : {cell, above}) {
      add_flux(cell, above, above, -0.5 * per_length, matrix(of_spread, deviation));
      add_flux(cell, above, cell, 0.5 * per_length, matrix(of_spread, deviation));
    }
  }
  for (const gas_end_of_segment& end : links_.ends()) {
    if (end.where.direction != direction) continue;
    const bool upper = end.where.upper;
    const int cell = end.cells[0];
    for (const auto& [of, weight] : edge_of(links_, direction, upper, cell, first_order_))
      add_flux(upper ? cell : -1, upper ? -1 : cell, of, weight, matrix(cell, layout_.end(end.where)));
  }
}

/// A force a gives the momentum ρa and the energy ρu·a per unit of time.
void macroscopic_system::whole_system::add_forces(assembly& to) const {
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

void macroscopic_system::whole_system::add_constraints(assembly& to) {
  const int cells = static_cast<int>(links_.cells().size()), unknowns = this->unknowns();
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

macroscopic_system::moments macroscopic_system::whole_system::solve(
    const moments& r, const std::vector<double>& missing) const {
  Eigen::VectorXd right = Eigen::VectorXd::Zero(unknowns() + constraints());
  for (const int cell : links_.cells())
    for (int i = 0; i < count_; ++i) right[number_[at(cell)] * count_ + i] = r[at(cell) * at(count_) + at(i)];
  int next = unknowns();
  for (std::size_t moment = 0; moment < at(count_); ++moment)
    if (conserved_[moment]) right[next++] = missing[moment] / static_cast<double>(links_.cells().size());
  if (neutral_) neutral_->remove_from_right_side(right);
  Eigen::VectorXd found = factors_.solve(right);
  if (neutral_) neutral_->remove_from_solution(found);
  moments change(r.size(), 0.0);
  for (const int cell : links_.cells())
    for (int i = 0; i < count_; ++i)
      change[at(cell) * at(count_) + at(i)] = found[number_[at(cell)] * count_ + i];
  return change;
}

macroscopic_system::macroscopic_system(const relaxation_model& equation, const problem_builder& space,
                                       const cell_links& links)
    : space_(space),
      acts_{space.force(), space.source()},
      jacobian_(equation, space.space(), links, acts_),
      count_(equation.moment_count()),
      conserved_(at(count_), false) {
  if (space.processes().is_root())
    whole_ = std::make_unique<whole_system>(equation, space, acts_, jacobian_.layout());
}

macroscopic_system::~macroscopic_system() = default;

bool macroscopic_system::build(const moments& omega, const std::vector<double>& rates, double pseudo_rate,
                               bool holds_neutral) {
  communicator& processes = space_.processes();
  std::vector<double> blocks;
  run_collectively(processes, [&] { blocks = jacobian_.compute(omega, rates); });
  blocks = gather_cells(space_, std::move(blocks), jacobian_.layout().numbers());
  run_collectively(processes, [&] {
    if (whole_) whole_->build(blocks, pseudo_rate, holds_neutral);
  });
  std::vector<std::byte> flags(at(count_) + 1);
  for (std::size_t k = 0; whole_ && k < conserved_.size(); ++k)
    flags[k] = static_cast<std::byte>(whole_->conserved()[k] ? 1 : 0);
  if (whole_) flags.back() = static_cast<std::byte>(whole_->has_neutral_mode() ? 1 : 0);
  processes.broadcast(flags);
  for (std::size_t k = 0; k < conserved_.size(); ++k) conserved_[k] = flags[k] != std::byte{0};
  return flags.back() != std::byte{0};
}

macroscopic_system::moments macroscopic_system::solve(const moments& r,
                                                      const std::vector<double>& missing) const {
  moments all = gather_cells(space_, r, count_);
  if (whole_) all = whole_->solve(all, missing);
  return scatter_cells(space_, std::move(all), count_);
}

}  // namespace apsis
