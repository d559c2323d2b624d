#include <apsis/steady/milder_ends.hpp>

#include <apsis/boundary/domain.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/core/index.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/internal/cell_measures.hpp>

#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace apsis {
namespace {

/// From one state to the next, differences in temperature and velocity from the start double.
constexpr std::size_t count = 6;

double share_of(std::size_t number) {
  return std::ldexp(1.0, static_cast<int>(number) - static_cast<int>(count));
}

/// Returns true if a boundary prescribes incoming components even if a pencil has enough cells
/// for mirror images. The axis is no end of the gas.
bool gives_what_enters(const boundary* side) {
  return side != nullptr && !side->is_axis() && side->prescribes_incoming(std::numeric_limits<int>::max(), 1);
}

/// Returns the equilibrium of the mean moments of all cells.
std::vector<double> mean_equilibrium(const relaxation_model& equation, const problem_builder& space,
                                     const field& start) {
  const cell_links links(space.space());
  const cell_measures cells(equation, space, links);
  std::vector<double> omega(at(start.cells() * equation.moment_count())), row(at(equation.components()));
  cells.moments_of(start, omega);
  std::vector<double> mean = cells.sums(omega);
  for (std::size_t i = mean.size(); i-- > 0;) mean[i] /= mean[0];
  if (!equation.equilibrium(mean.data(), row.data()))
    throw numerical_error(equation.why_inadmissible(mean.data()));
  return row;
}

}  // namespace

bool milder_ends::possible(const relaxation_model& equation, const problem_builder& space) {
  if (equation.as_gas() == nullptr) return false;
  const domain& whole = space.whole_space();
  for (std::size_t k = 0; k < whole.surfaces().size(); ++k) {
    if (whole.is_border_of_cut_cells(static_cast<int>(k))) return true;
    const boundary* side = whole.side(static_cast<int>(k));
    if (gives_what_enters(side)) return true;
  }
  return false;
}

milder_ends::milder_ends(const relaxation_model& equation, const problem_builder& space, const field& start,
                         int images)
    : continuation(equation, count, images),
      space_(std::make_shared<const problem_builder>(space)),
      row_(std::make_shared<const std::vector<double>>(mean_equilibrium(equation, space, start))) {}

problem_builder milder_ends::problem(std::size_t number) const {
  const domain& whole = space_->whole_space();
  const double share = share_of(number);
  // In axisymmetric flow the builder relates boundaries of f to F = r f.
  const auto of_builder = [&](const boundary& side) -> const boundary& {
    return space_->axis() ? side.undecorated() : side;
  };
  problem_builder milder(*space_);
  for (std::size_t k = 0; k < whole.surfaces().size(); ++k) {
    const surface& one = whole.surfaces()[k];
    const boundary* side = whole.side(static_cast<int>(k));
    if (one.solid >= 0 || !gives_what_enters(side)) continue;
    // The builder owns the domain, and the domain owns its boundaries.
    milder.with_boundary(one.where, milder_end({space_, &of_builder(*side)}, share, row_));
  }
  for (int solid = 0; solid < whole.mesh().obstacles(); ++solid) {
    const auto wall = whole.solid_boundary(solid);
    milder.with_solid(solid, milder_end({wall, &of_builder(*wall)}, share, row_));
  }
  return milder;
}

std::string milder_ends::name() const {
  return fmt::format(
      "steady states in which {:g} to {:g} of what enters is that of the ends, and the rest gas of the start",
      share_of(0), share_of(count - 1));
}

std::string milder_ends::name_of(std::size_t number) const {
  return fmt::format("{:g} of what enters at the ends", share_of(number));
}

}  // namespace apsis
