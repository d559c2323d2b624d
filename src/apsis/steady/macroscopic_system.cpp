#include <apsis/steady/macroscopic_system.hpp>

#include <apsis/core/index.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/semidiscrete/axisymmetric.hpp>
#include <apsis/semidiscrete/gathered_cells.hpp>
#include <apsis/steady/internal/moment_assembly.hpp>
#include <apsis/steady/internal/moment_solver.hpp>

#include <cstddef>
#include <span>
#include <utility>

namespace apsis {

namespace {

/// Times the enclosing scope on all threads.
profile::section timed(kernel which, std::size_t numbers) {
  return {which, static_cast<double>(numbers), {}, threads()};
}

/// Returns what acts inside the domain, on F = r f in axisymmetric flow.
inside_domain inside_of(const relaxation_model& equation, const problem_builder& space) {
  inside_domain found{space.force(), space.source(), {}};
  if (!space.axis()) return found;
  if (found.source) found.source = axisymmetric::source_of(std::move(*found.source), *space.axis());
  found.turn = ring_turn(equation.polar(), !space.first_order());
  return found;
}

}  // namespace

/// J of the whole mesh.
class macroscopic_system::whole_system {
 public:
  whole_system(const relaxation_model& equation, const problem_builder& builder, const inside_domain& acts,
               const jacobian_layout& layout, bool first_order)
      : assembly_(equation, builder.whole_space(), acts, layout, first_order), solver_(assembly_.mesh()) {}

  /// `blocks` are those of all cells, [cell][layout.numbers()].
  void build(std::span<const double> blocks, double pseudo_rate, bool holds_neutral) {
    moment_equations equations = assembly_.assemble(blocks, pseudo_rate);
    conserved_ = equations.conserved;
    solver_.take(std::move(equations), holds_neutral);
  }
  /// Returns the moments with sums that only the initial data determine.
  const std::vector<int>& conserved() const { return conserved_; }
  bool has_neutral_mode() const { return solver_.has_neutral_mode(); }
  moments solve(const moments& r, const std::vector<double>& missing);

 private:
  moment_assembly assembly_;
  moment_solver solver_;
  std::vector<int> conserved_;
};

macroscopic_system::moments macroscopic_system::whole_system::solve(const moments& r,
                                                                    const std::vector<double>& missing) {
  const moment_mesh& mesh = assembly_.mesh();
  const int count = mesh.moments;
  Eigen::VectorXd right(mesh.unknowns() + static_cast<int>(conserved_.size()));
  for (const int cell : assembly_.cells())
    for (int i = 0; i < count; ++i) right[assembly_.number(cell) * count + i] = r[at(cell * count + i)];
  int next = mesh.unknowns();
  for (const int moment : conserved_) right[next++] = missing[at(moment)] / mesh.cells;
  const Eigen::VectorXd found = solver_.solve(std::move(right));
  moments change(r.size(), 0.0);
  for (const int cell : assembly_.cells())
    for (int i = 0; i < count; ++i) change[at(cell * count + i)] = found[assembly_.number(cell) * count + i];
  return change;
}

double macroscopic_system::bytes_of_cell(int directions, int moments, double cells, bool turns) {
  const double square = moments * moments, of_entry = sizeof(double) + sizeof(int),
               around = 4.0 * directions + 1.0;  // cells whose moments occur in an equation
  // Blocks of J by direction and their sum; the matrix by rows, the previous one, and the matrix by columns.
  const double blocks = (5.0 * directions + 1.0 + (turns ? 4.0 : 0.0) + around) * square * sizeof(double),
               matrices = 3.0 * around * square * of_entry;
  return blocks + matrices + moment_solver::numbers_of_cell(directions, moments, cells) * sizeof(double);
}

macroscopic_system::macroscopic_system(const relaxation_model& equation, const problem_builder& space,
                                       const cell_links& links, bool first_order)
    : space_(space),
      acts_(inside_of(equation, space)),
      cut_(space.space()),
      jacobian_(equation, space.space(), links, cut_, acts_),
      count_(equation.moment_count()),
      conserved_(at(count_), false) {
  if (space.processes().is_root())
    whole_ = std::make_unique<whole_system>(equation, space, acts_, jacobian_.layout(),
                                            first_order || space.first_order());
}

macroscopic_system::~macroscopic_system() = default;

bool macroscopic_system::build(const moments& omega, const std::vector<double>& rates, double pseudo_rate,
                               bool holds_neutral) {
  communicator& processes = space_.processes();
  std::vector<double> blocks;
  run_collectively(processes, [&] {
    const auto section = timed(kernel::derivatives, rates.size());
    blocks = jacobian_.compute(omega, rates);
  });
  const auto section = timed(kernel::correction, 0);
  blocks = gather_cells(space_, std::move(blocks), jacobian_.layout().numbers());
  run_collectively(processes, [&] {
    if (whole_) whole_->build(blocks, pseudo_rate, holds_neutral);
  });
  std::vector<std::byte> flags(at(count_) + 1);
  if (whole_)
    for (const int moment : whole_->conserved()) flags[at(moment)] = std::byte{1};
  if (whole_) flags.back() = static_cast<std::byte>(whole_->has_neutral_mode() ? 1 : 0);
  processes.broadcast(flags);
  for (std::size_t k = 0; k < conserved_.size(); ++k) conserved_[k] = flags[k] != std::byte{0};
  return flags.back() != std::byte{0};
}

macroscopic_system::moments macroscopic_system::solve(const moments& r,
                                                      const std::vector<double>& missing) const {
  const auto section = timed(kernel::correction, r.size());
  moments all = gather_cells(space_, r, count_);
  if (whole_) all = whole_->solve(all, missing);
  return scatter_cells(space_, std::move(all), count_);
}

}  // namespace apsis
