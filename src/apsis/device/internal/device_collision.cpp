#include <apsis/device/internal/device_collision.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/model/velocity_rows.hpp>

#include <utility>

namespace apsis {
namespace {

static_assert(velocity_rows::longest_chain == scalar::longest_chain_of_line, "host and device halve alike");

/// A copy of a state on the host.
field on_host(const field& u) {
  field copy(u.cells(), u.components());
  copy.copy_rows(u);
  return copy;
}

const gas_model& gas_of(const model& equation, stage_solution stages) {
  if (const std::string reason = device_collision::why_not(equation, stages); !reason.empty())
    throw input_error("the run is not possible on a device (" + reason + "); run it on the host");
  return *equation.as_gas();
}

/// Lanes that share the work on a cell.
constexpr int lanes_of_cell = scalar::octet_length;

/// Points of all directions together.
int points_of(const velocity_grid& grid) {
  int points = 0;
  for (int k = 0; k < grid.dimensions(); ++k) points += grid.line(k).points();
  return points;
}

/// Numbers that a cell needs in the memory of a block.
std::size_t shared_by_cell(const velocity_grid& grid) {
  return static_cast<std::size_t>(kernels::most_totals * lanes_of_cell + points_of(grid));
}

/// Memory that blocks have on every device, 48 KiB.
constexpr std::size_t most_shared = 6144;

/// A launch for so many cells, with as many of them in a block as its memory and 128 lanes allow.
launch_size launch_of_cells(int cells, const velocity_grid& grid) {
  const std::size_t of_cell = shared_by_cell(grid);
  int together = 16;
  while (static_cast<std::size_t>(together) * of_cell > most_shared) together /= 2;
  return {(cells + together - 1) / together, together * lanes_of_cell,
          static_cast<std::size_t>(together) * of_cell};
}

bool has_too_many_velocities(const velocity_grid& grid) {
  return (grid.dimensions() == 1 && grid.size() > kernels::collide::most_velocities_of_line) ||
         grid.lines() > kernels::collide::most_lines || shared_by_cell(grid) > most_shared;
}

/// The numbers of all directions, one after the other.
template <class Numbers>
std::vector<double> of_directions(const velocity_grid& grid, const Numbers& numbers) {
  std::vector<double> all;
  for (int k = 0; k < grid.dimensions(); ++k) {
    const auto& some = (grid.line(k).*numbers)();
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

/// Factors in the sums of the kernel: ½v² on an even line, functions of all lines otherwise.
const aligned_vector<double>& functions_of(const velocity_grid& grid) {
  return grid.dimensions() == 1 && grid.uniform() ? grid.half_square() : grid.functions_of_lines();
}

kernels::collide::formulas closed_forms(equilibrium_choice choice) {
  using kernels::collide;
  return choice == equilibrium_choice::formula    ? collide::all
         : choice == equilibrium_choice::discrete ? collide::none
                                                  : collide::where_exact;
}

}  // namespace

std::string device_collision::why_not(const model& equation, stage_solution stages) {
  const gas_model* gas = equation.as_gas();
  if (gas == nullptr || gas->relaxing_count() > 0) return "the kernel of its collisions is missing";
  const velocity_grid& grid = gas->molecules().grid();
  if (gas->molecules().reduced())
    return "the kernel of its collisions has no degrees of freedom beside the velocities";
  if (grid.is_polar()) return "the kernel of its collisions has no rings of velocities";
  if (gas->rate_exponent() && *gas->rate_exponent() != 0.5)
    return "the kernel of its collisions has the viscosity of hard spheres alone";
  if (has_too_many_velocities(grid)) return "it has too many velocities";
  if (stages == stage_solution::exact) return "the kernel of exact collisions is missing";
  return "";
}

device_collision::device_collision(device& on, const model& equation, std::vector<double> epsilon,
                                   bool keeps_sign, std::vector<cell_range> cells, stage_solution stages)
    : device_(on),
      gas_(gas_of(equation, stages)),
      epsilon_(std::move(epsilon)),
      cells_(std::move(cells)),
      host_(make_pointwise_collision(equation, epsilon_, keeps_sign, cells_, stages)),
      v_(of_directions(gas_.molecules().grid(), &velocity_line::v), device_.memory()),
      quadrature_(of_directions(gas_.molecules().grid(), &velocity_line::weights), device_.memory()),
      functions_(functions_of(gas_.molecules().grid()), device_.memory()),
      epsilon_on_device_(epsilon_, device_.memory()),
      marks_(epsilon_.size(), device_.memory()),
      marks_on_host_(epsilon_.size()) {
  if (cells_.empty()) cells_.push_back({0, static_cast<int>(epsilon_.size())});
  const field row(1, equation.components());
  rest_ = equation.make_collision({1, row.stride(), keeps_sign, stages});
}

/// All but the stage.
kernels::collide::arguments device_collision::arguments() const {
  const velocity_grid& grid = gas_.molecules().grid();
  kernels::collide::arguments of{};
  int before = 0;
  for (int k = 0; k < grid.dimensions(); ++k) {
    const velocity_line& line = grid.line(k);
    of.of[k] = {.v = v_.data() + before,
                .weights = grid.uniform() ? nullptr : quadrature_.data() + before,
                .n = line.points(),
                .even = line.uniform() ? 1 : 0,
                .spacing = line.spacing(),
                .max = line.max()};
    before += line.points();
  }
  of.functions = functions_.data();
  of.dimensions = grid.dimensions();
  of.points = before;
  of.uniform = grid.uniform() ? 1 : 0;
  of.closed_forms = closed_forms(gas_.molecules().choice());
  of.weight = grid.weight();
  return of;
}

void device_collision::solve(double, double a, double b, field& u) {
  kernels::collide::arguments of = arguments();
  of.stage = {.u = u.row(0),
              .marks = marks_.data(),
              .epsilon = epsilon_on_device_.data(),
              .stride = u.stride(),
              .first = 0,
              .last = 0,
              .by_viscosity = gas_.rate_exponent() ? 1 : 0,
              .prandtl = gas_.prandtl(),
              .a = a,
              .b = b};
  for (const cell_range& some : cells_) {
    of.stage.first = some.begin;
    of.stage.last = some.end;
    device_.launch<kernels::collide>(launch_of_cells(some.end - some.begin, gas_.molecules().grid()), of);
    solve_rest(a, b, some, u);
  }
}

/// Solves the cells that the kernel has left.
void device_collision::solve_rest(double a, double b, const cell_range& cells, field& u) {
  const memory_space& memory = device_.memory();
  const auto first = static_cast<std::size_t>(cells.begin),
             count = static_cast<std::size_t>(cells.end) - first;
  memory.copy_to_host(marks_.data() + first, count, marks_on_host_.data() + first);
  const auto width = static_cast<std::size_t>(u.stride());
  aligned_vector<double> row(width);
  for (int cell = cells.begin; cell < cells.end; ++cell) {
    if (marks_on_host_[static_cast<std::size_t>(cell)] == 0.0) continue;
    ++solved_on_host_;
    memory.copy_to_host(u.row(cell), width, row.data());
    rest_->solve_stage(
        a, b, {.count = 1, .pitch = u.stride(), .epsilon = epsilon_.data() + cell, .first_cell = cell},
        row.data());
    memory.copy_from_host(row.data(), width, u.row(cell));
  }
}

void device_collision::add_collision(double t, const field& u,
                                     std::span<const target<field, double>> targets) {
  std::vector<field> copies;
  copies.reserve(targets.size());
  std::vector<target<field, double>> there;
  for (const auto& to : targets) {
    copies.push_back(to.fresh ? field(u.cells(), u.components()) : on_host(*to.acc));
    there.push_back({&copies.back(), to.alpha, to.beta, to.fresh});
  }
  host_->add_collision(t, on_host(u), there);
  for (std::size_t k = 0; k < targets.size(); ++k) targets[k].acc->copy_rows(copies[k]);
}

double device_collision::forward_euler_step(const field& u) const {
  return host_->forward_euler_step(on_host(u));
}

double device_collision::relaxation_time(const field& u) const {
  return host_->relaxation_time(on_host(u));
}

}  // namespace apsis
