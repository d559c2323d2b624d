#include <apsis/steady/negative_values.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/model/gas_model.hpp>
#include <apsis/model/gas_target.hpp>

#include <algorithm>
#include <cstddef>

namespace apsis {
namespace {

/// Makes single rows nonnegative.
class row_projection {
 public:
  explicit row_projection(const relaxation_model& equation)
      : equation_(equation),
        omega_(at(equation.moment_count())),
        cut_(at(equation.components())),
        found_(at(equation.components())) {}

  /// Returns false if the row has no equilibrium.
  bool apply(double* row) {
    equation_.moments(row, omega_.data());
    if (const gas_model* gas = equation_.as_gas(); gas != nullptr && correct_tails(*gas, row)) return true;
    return mix_with_equilibrium(row);
  }
  const double* moments() const { return omega_.data(); }

 private:
  bool correct_tails(const gas_model& gas, double* row) {
    const fluid_state state = gas.molecules().state(omega_.data());
    if (!state.admissible()) return false;
    for (std::size_t k = 0; k < cut_.size(); ++k) cut_[k] = std::max(row[k], 0.0);
    target_shape shape;
    shape.variance = state.T;
    bool raised = false;
    constexpr double lowest_share = 0.0;
    if (!conservative_target(gas.molecules(), omega_.data(), {cut_.data(), {}}, shape, cut_.data(),
                             lowest_share, found_.data(), raised))
      return false;
    std::copy(found_.begin(), found_.end(), row);
    return true;
  }

  bool mix_with_equilibrium(double* row) {
    if (!equation_.equilibrium(omega_.data(), found_.data())) return false;
    double share = 0.0;
    for (std::size_t k = 0; k < found_.size(); ++k)
      if (row[k] < 0.0) share = std::max(share, row[k] / (row[k] - found_[k]));
    for (std::size_t k = 0; k < found_.size(); ++k)
      row[k] = std::max((1.0 - share) * row[k] + share * found_[k], 0.0);
    return true;
  }

  const relaxation_model& equation_;
  std::vector<double> omega_;
  aligned_vector<double> cut_, found_;
};

}  // namespace

removed_values remove_negative_values(const relaxation_model& equation, const domain& space,
                                      const std::vector<int>& cells, field& f) {
  removed_values removed;
  row_projection project(equation);
  for (const int cell : cells) {
    double* row = f.row(cell);
    const std::int64_t before = removed.count;
    for (int k = 0; k < f.components(); ++k)
      if (row[k] < 0.0) {
        ++removed.count;
        removed.lowest = std::min(removed.lowest, row[k]);
      }
    if (removed.count > before && !project.apply(row))
      throw numerical_error(equation.why_inadmissible(project.moments()),
                            {.cell = space.number_in_whole_mesh(cell), .value = project.moments()[0]});
  }
  return removed;
}

}  // namespace apsis
