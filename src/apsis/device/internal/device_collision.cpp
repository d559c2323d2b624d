#include <apsis/device/internal/device_collision.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/device/internal/kernels/collide_line.hpp>
#include <apsis/exec/aligned.hpp>

#include <utility>

namespace apsis {
namespace {

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

}  // namespace

std::string device_collision::why_not(const model& equation, stage_solution stages) {
  const gas_model* gas = equation.as_gas();
  if (gas == nullptr || gas->relaxing_count() > 0) return "the kernel of its collisions is missing";
  const velocity_grid& grid = gas->molecules().grid();
  if (gas->molecules().reduced() || grid.dimensions() != 1 || !grid.uniform() ||
      gas->molecules().choice() == equilibrium_choice::discrete)
    return "its collisions have a kernel on an even line of velocities alone, with equilibria in closed form";
  if (gas->rate_exponent() && *gas->rate_exponent() != 0.5)
    return "the kernel of its collisions has the viscosity of hard spheres alone";
  if (grid.size() > kernels::collide_line::most_velocities) return "it has too many velocities";
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
      v_(gas_.molecules().grid().last_line().v(), device_.memory()),
      half_square_(gas_.molecules().grid().half_square(), device_.memory()),
      epsilon_on_device_(epsilon_, device_.memory()),
      marks_(epsilon_.size(), device_.memory()),
      marks_on_host_(epsilon_.size()) {
  if (cells_.empty()) cells_.push_back({0, static_cast<int>(epsilon_.size())});
  const field row(1, equation.components());
  rest_ = equation.make_collision({1, row.stride(), keeps_sign, stages});
}

void device_collision::solve(double, double a, double b, field& u) {
  using kernel = kernels::collide_line;
  const velocity_grid& grid = gas_.molecules().grid();
  for (const cell_range& some : cells_) {
    kernel::arguments of{};
    of.u = u.row(0);
    of.marks = marks_.data();
    of.v = v_.data();
    of.half_square = half_square_.data();
    of.epsilon = epsilon_on_device_.data();
    of.stride = u.stride();
    of.first = some.begin;
    of.last = some.end;
    of.n = grid.size();
    of.any_formula = gas_.molecules().choice() == equilibrium_choice::formula ? 1 : 0;
    of.by_viscosity = gas_.rate_exponent() ? 1 : 0;
    of.spacing = grid.last_line().spacing();
    of.weight = grid.weight();
    of.max = grid.last_line().max();
    of.prandtl = gas_.prandtl();
    of.a = a;
    of.b = b;
    device_.launch<kernel>(
        {(some.end - some.begin + kernel::cells - 1) / kernel::cells, kernel::lanes, kernel::lanes}, of);
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
