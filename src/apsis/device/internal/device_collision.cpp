#include <apsis/device/internal/device_collision.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/device/internal/kernels/collide.hpp>
#include <apsis/device/internal/kernels/collide_es_bgk.hpp>
#include <apsis/device/internal/kernels/collide_shakhov.hpp>
#include <apsis/exec/aligned.hpp>

#include <algorithm>
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

/// Lanes that share the work on a cell.
constexpr int lanes_of_cell = scalar::octet_length;

/// Returns how many numbers a cell needs in the memory of a block.
std::size_t shared_by_cell(const gas_model& gas, const kernels::gas_rows& rows) {
  using namespace kernels;
  int numbers = most_totals * lanes_of_cell;
  if (gas.as_ellipsoidal() != nullptr)
    numbers += memory_of_central_sums::powers_of(rows, collide_es_bgk::degree);
  else if (gas.as_shakhov() != nullptr)
    numbers += rows.points + memory_of_central_sums::powers_of(rows, collide_shakhov::degree);
  else
    numbers += rows.points;
  return static_cast<std::size_t>(numbers);
}

/// Returns how many numbers a cell needs in the memory of the device.
std::size_t room_of_cell(const gas_model& gas, const kernels::gas_rows& rows) {
  using namespace kernels;
  return static_cast<std::size_t>(gas.as_ellipsoidal() != nullptr ? collide_es_bgk::numbers_of_room(rows)
                                  : gas.as_shakhov() != nullptr   ? collide_shakhov::numbers_of_room(rows)
                                                                  : 0);
}

/// Numbers of shared memory that a block has on every device, 48 KiB.
constexpr std::size_t most_shared = 6144;

/// Returns a launch for `cells` cells. A block has as many of them as its memory and 128 lanes allow.
launch_size launch_of_cells(int cells, std::size_t shared_by_cell) {
  int together = launch_room::cells_of_block;
  while (static_cast<std::size_t>(together) * shared_by_cell > most_shared) together /= 2;
  return {(cells + together - 1) / together, together * lanes_of_cell,
          static_cast<std::size_t>(together) * shared_by_cell};
}

kernels::equilibrium_formulas closed_forms(equilibrium_choice choice) {
  using kernels::equilibrium_formulas;
  return choice == equilibrium_choice::formula    ? equilibrium_formulas::all
         : choice == equilibrium_choice::discrete ? equilibrium_formulas::none
                                                  : equilibrium_formulas::where_exact;
}

}  // namespace

std::string device_collision::why_not(const model& equation, stage_solution stages) {
  const gas_model* gas = equation.as_gas();
  if (gas == nullptr ||
      (gas->relaxing_count() > 0 && gas->as_shakhov() == nullptr && gas->as_ellipsoidal() == nullptr))
    return "the kernel of its collisions is missing";
  if (std::string reason = device_gas_rows::why_not(gas->molecules()); !reason.empty()) return reason;
  if (shared_by_cell(*gas, device_gas_rows::shape(gas->molecules())) > most_shared)
    return "it has too many velocities";
  if (stages == stage_solution::exact) return "the kernel of exact collisions is missing";
  return "";
}

device_collision::device_collision(device& on, const model& equation, std::vector<double> epsilon,
                                   bool keeps_sign, std::vector<cell_range> cells, stage_solution stages)
    : device_(on),
      gas_(gas_of(equation, stages)),
      epsilon_(std::move(epsilon)),
      cells_(cells.empty() ? std::vector<cell_range>{{0, static_cast<int>(epsilon_.size())}}
                           : std::move(cells)),
      host_(make_pointwise_collision(equation, epsilon_, keeps_sign, cells_, stages)),
      rows_(device_, gas_.molecules()),
      epsilon_on_device_(epsilon_, device_.memory()),
      marks_(epsilon_.size(), device_.memory()),
      marks_on_host_(epsilon_.size()),
      room_(device_.memory(), cells_, room_of_cell(gas_, rows_.view())) {
  const field row(1, equation.components());
  rest_ = equation.make_collision({1, row.stride(), keeps_sign, stages});
}

void device_collision::solve(double, double a, double b, field& u) {
  kernels::collision_stage stage{.u = u.row(0),
                                 .marks = marks_.data(),
                                 .epsilon = epsilon_on_device_.data(),
                                 .stride = u.stride(),
                                 .first = 0,
                                 .last = 0,
                                 .by_viscosity = gas_.rate_exponent() ? 1 : 0,
                                 .rate = {gas_.prandtl(), gas_.rate_exponent().value_or(0.0)},
                                 .a = a,
                                 .b = b};
  for (const cell_range& some : cells_) {
    room_.for_parts(some, [&](int first, int last) {
      stage.first = first;
      stage.last = last;
      launch(stage);
    });
    solve_rest(a, b, some, u);
  }
}

/// Solves a stage of some cells on the device.
void device_collision::launch(const kernels::collision_stage& stage) {
  const kernels::gas_rows rows = rows_.view();
  const launch_size size = launch_of_cells(stage.last - stage.first, shared_by_cell(gas_, rows));
  const auto formulas = closed_forms(gas_.molecules().choice());
  const int cuts_tails = gas_.collisions_keep_sign() ? 1 : 0;
  if (const auto* target = gas_.as_shakhov())
    device_.launch<kernels::collide_shakhov>(size,
                                             {stage, rows, *target, room_.data(), formulas, cuts_tails});
  else if (const auto* model = gas_.as_ellipsoidal())
    device_.launch<kernels::collide_es_bgk>(size, {stage, rows, *model, room_.data(), cuts_tails});
  else
    device_.launch<kernels::collide>(size, {stage, rows, formulas});
}

/// Solves on the host the cells that the kernel has left unchanged.
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

double device_collision::take_cut() {
  const double here = host_->take_cut(), of_rest = rest_->take_cut();
  return std::max(here, of_rest);
}

double device_collision::forward_euler_step(const field& u) const {
  return host_->forward_euler_step(on_host(u));
}

double device_collision::relaxation_time(const field& u) const {
  return host_->relaxation_time(on_host(u));
}

}  // namespace apsis
