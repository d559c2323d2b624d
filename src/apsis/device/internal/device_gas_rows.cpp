#include <apsis/device/internal/device_gas_rows.hpp>

#include <apsis/model/velocity_rows.hpp>

#include <span>
#include <vector>

namespace apsis {
namespace {

static_assert(velocity_rows::longest_chain == scalar::longest_chain_of_line, "host and device halve alike");

/// Returns the numbers of all directions, one direction after the other.
template <class Numbers>
std::vector<double> of_directions(const velocity_grid& grid, const Numbers& numbers) {
  std::vector<double> all;
  for (int k = 0; k < grid.dimensions(); ++k) {
    const auto& some = (grid.line(k).*numbers)();
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

/// Returns the factors in the sums of kernels: ½v² on an evenly spaced line, otherwise the functions of
/// all lines.
const aligned_vector<double>& functions_of(const velocity_grid& grid) {
  return grid.dimensions() == 1 && grid.uniform() ? grid.half_square() : grid.functions_of_lines();
}

/// Returns the weights of all velocities; an empty list if they are equal.
std::span<const double> weights_of(const velocity_grid& grid) {
  return grid.uniform() ? std::span<const double>() : grid.set().weights();
}

}  // namespace

std::string device_gas_rows::why_not(const gas& molecules) {
  const velocity_grid& grid = molecules.grid();
  if (grid.is_polar()) return "no kernel has rings of velocities";
  if ((grid.dimensions() == 1 && grid.size() > kernels::gas_rows::most_velocities_of_line) ||
      grid.lines() > kernels::gas_rows::most_lines)
    return "it has too many velocities";
  return "";
}

device_gas_rows::device_gas_rows(const device& on, const gas& molecules)
    : gas_(molecules),
      v_(of_directions(molecules.grid(), &velocity_line::v), on.memory()),
      quadrature_(of_directions(molecules.grid(), &velocity_line::weights), on.memory()),
      functions_(functions_of(molecules.grid()), on.memory()),
      weights_(weights_of(molecules.grid()), on.memory()) {}

kernels::gas_rows device_gas_rows::shape(const gas& molecules) {
  const velocity_grid& grid = molecules.grid();
  kernels::gas_rows rows{};
  for (int k = 0; k < grid.dimensions(); ++k) {
    const velocity_line& line = grid.line(k);
    rows.of[k] = {.v = nullptr,
                  .weights = nullptr,
                  .n = line.points(),
                  .even = line.uniform() ? 1 : 0,
                  .spacing = line.spacing(),
                  .max = line.max()};
    rows.points += line.points();
  }
  rows.dimensions = grid.dimensions();
  rows.degrees = molecules.degrees_of_freedom();
  rows.size = grid.size();
  rows.uniform = grid.uniform() ? 1 : 0;
  rows.weight = grid.weight();
  return rows;
}

kernels::gas_rows device_gas_rows::view() const {
  kernels::gas_rows rows = shape(gas_);
  const bool uniform = rows.uniform != 0;
  for (int k = 0, before = 0; k < rows.dimensions; before += rows.of[k++].n) {
    rows.of[k].v = v_.data() + before;
    if (!uniform) rows.of[k].weights = quadrature_.data() + before;
  }
  rows.functions = functions_.data();
  if (!uniform) rows.weights = weights_.data();
  return rows;
}

}  // namespace apsis
