#include <apsis/device/internal/device_cut_cells.hpp>

#include <apsis/core/index.hpp>
#include <apsis/device/internal/kernels/add_rates.hpp>
#include <apsis/device/internal/row_launch.hpp>

#include <algorithm>
#include <map>

namespace apsis {

device_cut_cells::device_cut_cells(device& on, const model& equation, const std::shared_ptr<domain>& space,
                                   const limited_reconstruction& edges, face_fluxes& faces)
    : device_(on),
      host_(equation, space, edges, faces),
      stride_(at(field(1, equation.components()).stride())),
      row_of_(at(space->mesh().size()), -1) {
  const cut_cells& cut = *space->mesh().cut();
  std::map<int, int> rows;  // by group
  std::vector<std::array<int, 2>> cells;
  for (int cell = 0; cell < space->mesh().size(); ++cell) {
    const int group = cut.group_of(static_cast<int>(space->number_in_whole_mesh(cell)));
    if (group < 0) continue;
    row_of_[at(cell)] = rows.try_emplace(group, static_cast<int>(rows.size())).first->second;
    cells.push_back({cell, row_of_[at(cell)]});
  }
  cells_ = device_array<std::array<int, 2>>(cells, on.memory());
  rates_.resize(rows.size() * stride_);
  rates_on_device_ = stored_numbers(rates_.size(), on.memory());
}

void device_cut_cells::add(double t, const field& mirror, const field& u,
                           std::span<const target<field, double>> targets) {
  const auto width = static_cast<std::ptrdiff_t>(u.components());
  host_.evaluate(t, mirror, [&](const std::vector<int>& cells, const double* rate) {
    std::copy_n(rate, width, rates_.data() + at(row_of_[at(cells.front())]) * stride_);
  });
  if (cells_.size() == 0) return;
  device_.memory().copy_from_host(rates_.data(), rates_.size(), rates_on_device_.data());
  for (const auto& to : targets)
    device_.launch<kernels::add_rates>(
        launch_for(cells_.size() * stride_),
        {to.acc->row(0), u.row(0), rates_on_device_.data(), cells_.data()->data(), static_cast<long>(stride_),
         static_cast<long>(cells_.size()), to.alpha, to.beta, to.fresh ? 1 : 0});
}

}  // namespace apsis
