#include <apsis/device/row_checks.hpp>

#include <apsis/device/internal/device_gas_rows.hpp>
#include <apsis/device/internal/gas_cells.hpp>
#include <apsis/device/internal/kernels/check_gas.hpp>
#include <apsis/device/internal/kernels/compare_rows.hpp>
#include <apsis/mesh/on_host.hpp>
#include <apsis/model/gas_model.hpp>

#include <cstddef>

namespace apsis {
namespace {

/// Returns the size of a launch for `count` cells.
template <class Kernel>
launch_size launch_of_cells(int count) {
  return {(count + Kernel::cells - 1) / Kernel::cells, Kernel::lanes,
          static_cast<std::size_t>(kernels::most_totals * Kernel::lanes)};
}

class checks_of_gas final : public device_row_checks {
 public:
  checks_of_gas(device& on, const gas_model& gas, const grid& mesh)
      : device_(on),
        cells_(gas_cells(mesh)),
        rows_(on, gas.molecules()),
        numbers_(kernel::numbers(gas.molecules().dimensions())),
        checks_(static_cast<std::size_t>(mesh.size()) * static_cast<std::size_t>(numbers_), on.memory()),
        on_host_(checks_.size()) {}

  void evaluate(const field& u) override {
    kernel::arguments of{};
    of.u = u.row(0);
    of.checks = checks_.data();
    of.rows = rows_.view();
    of.stride = u.stride();
    for (const cell_range& some : cells_) {
      of.first = some.begin;
      of.last = some.end;
      device_.launch<kernel>(launch_of_cells<kernel>(some.end - some.begin), of);
    }
    device_.memory().copy_to_host(checks_.data(), on_host_.size(), on_host_.data());
    for (const cell_range& some : cells_)
      for (int cell = some.begin; cell < some.end; ++cell)
        if (checks_of(cell)[kernel::unclear] != 0.0) {
          std::vector<double> room;
          checks_of(cell)[kernel::lowest] =
              compute_extremes(row_on_host(u, cell, room).data(), u.components()).lowest;
        }
  }

  row of(int cell) const override {
    const double* here = on_host_.data() + first_of(cell);
    return {{here[kernel::lowest], static_cast<long>(here[kernel::negative])},
            here + kernel::density,
            here[kernel::entropy]};
  }

 private:
  using kernel = kernels::check_gas;

  std::size_t first_of(int cell) const {
    return static_cast<std::size_t>(cell) * static_cast<std::size_t>(numbers_);
  }
  double* checks_of(int cell) { return on_host_.data() + first_of(cell); }

  device& device_;
  std::vector<cell_range> cells_;
  device_gas_rows rows_;
  int numbers_;
  stored_numbers checks_;
  std::vector<double> on_host_;
};

}  // namespace

std::vector<row_squares> compute_squares(device& on, const field& u, const field& v) {
  using kernel = kernels::compare_rows;
  static_assert(sizeof(row_squares) == kernel::numbers * sizeof(double));
  std::vector<row_squares> squares(static_cast<std::size_t>(u.cells()));
  const std::size_t numbers = squares.size() * kernel::numbers;
  stored_numbers there(numbers, on.memory());
  on.launch<kernel>(launch_of_cells<kernel>(u.cells()),
                    {u.row(0), v.row(0), there.data(), u.stride(), u.cells(), u.components()});
  on.memory().copy_to_host(there.data(), numbers, &squares.data()->difference);
  return squares;
}

std::unique_ptr<device_row_checks> device_row_checks::make(device& on, const model& equation,
                                                           const grid& mesh) {
  const gas_model* gas = equation.as_gas();
  if (gas == nullptr || !equation.condition().empty()) return nullptr;
  if (!device_gas_rows::why_not(gas->molecules()).empty()) return nullptr;
  return std::make_unique<checks_of_gas>(on, *gas, mesh);
}

}  // namespace apsis
