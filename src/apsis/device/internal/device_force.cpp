#include <apsis/device/internal/device_force.hpp>

#include <apsis/core/first_error.hpp>
#include <apsis/device/internal/gas_cells.hpp>
#include <apsis/device/internal/kernels/add_force.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace apsis {
namespace {

using force_kernel = kernels::add_force;

static_assert(force_kernel::cells == launch_room::cells_of_block);

int most_lines_of(const force& of, const velocity_lattice& lattice) {
  std::size_t most = 0;
  for (std::size_t k = 0; k < lattice.points.size(); ++k) most = std::max(most, of.layout_along(k).lines());
  return static_cast<int>(most);
}

}  // namespace

device_force::device_force(device& on, const gas_model& gas, std::shared_ptr<domain> space, acceleration of,
                           const limited_reconstruction& edges)
    : device_(on),
      space_(std::move(space)),
      lattice_(gas.lattice()),
      host_(gas, space_, std::move(of), edges),
      rows_(on, gas.molecules()),
      weights_(gas.velocities().weights(), on.memory()),
      cells_(gas_cells(space_->mesh())),
      components_(gas.components()),
      most_lines_(most_lines_of(host_, lattice_)),
      room_(on.memory(), cells_,
            static_cast<std::size_t>(force_kernel::numbers_of_room(components_, most_lines_))) {
  const auto all = static_cast<std::size_t>(space_->mesh().size());
  accelerations_.resize(3 * all);
  sums_on_host_.resize(all * host_.sums_of_cell());
  accelerations_on_device_ = stored_numbers(accelerations_.size(), on.memory());
  sums_ = stored_numbers(sums_on_host_.size(), on.memory());
  on.memory().copy_from_host(sums_on_host_.data(), sums_on_host_.size(), sums_.data());
}

void device_force::set_accelerations(double t) {
  for (const cell_range& some : cells_)
    for (int cell = some.begin; cell < some.end; ++cell) {
      const auto a = host_.acceleration_in(t, cell);
      std::copy(a.begin(), a.end(), accelerations_.begin() + 3l * cell);
    }
  device_.memory().copy_from_host(accelerations_.data(), accelerations_.size(),
                                  accelerations_on_device_.data());
}

void device_force::add(double t, const field& u, std::span<const target<field, double>> targets) {
  first_error failure;
  failure.run([&] {
    set_accelerations(t);
    change(u, targets);
  });
  host_.balance(sums_on_host_, [this](int cell) {
    const double* a = accelerations_.data() + 3l * cell;
    return std::array{a[0], a[1], a[2]};
  });
  failure.rethrow();
}

void device_force::change(const field& u, std::span<const target<field, double>> targets) {
  const lattice_rows::flux_rule rule = host_.rule_for(1.0);
  force_kernel::arguments of{};
  of.u = u.row(0);
  of.a = accelerations_on_device_.data();
  of.weights = weights_.data();
  of.room = room_.data();
  of.sums = sums_.data();
  of.rows = rows_.view();
  for (std::size_t k = 0; k < lattice_.points.size(); ++k) {
    const lattice_rows::layout at = host_.layout_along(k);
    of.along[k] = {at.blocks, at.points, at.apart, lattice_.spacing[k]};
  }
  of.stride = u.stride();
  of.inverse_cfl = rule.inverse_cfl;
  of.components = components_;
  of.most_lines = most_lines_;
  of.fifth_order = rule.fifth_order ? 1 : 0;
  of.limited = rule.limited ? 1 : 0;
  constexpr auto most = static_cast<std::size_t>(force_kernel::most_targets);
  for (std::size_t first = 0; first < targets.size(); first += most) {
    of.targets = static_cast<int>(std::min(most, targets.size() - first));
    for (std::size_t n = 0; n < static_cast<std::size_t>(of.targets); ++n)
      of.to[n] = {targets[first + n].acc->row(0), targets[first + n].beta};
    for (const cell_range& some : cells_)
      room_.for_parts(some, [&](int begin, int end) {
        of.first = begin;
        of.last = end;
        const int blocks = (end - begin + force_kernel::cells - 1) / force_kernel::cells;
        device_.launch<force_kernel>({blocks, force_kernel::lanes,
                                      static_cast<std::size_t>(kernels::most_totals * force_kernel::lanes)},
                                     of);
      });
  }
  device_.memory().copy_to_host(sums_.data(), sums_on_host_.size(), sums_on_host_.data());
}

}  // namespace apsis
