#include <apsis/model/gas_target.hpp>

#include <apsis/exec/aligned.hpp>
#include <apsis/model/central_sums.hpp>
#include <apsis/model/formulas/ellipsoidal.hpp>
#include <apsis/model/formulas/shakhov.hpp>
#include <apsis/model/polar_maxwellian.hpp>
#include <apsis/model/target_rows.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace apsis {
namespace {

target_rows::lines_of_row lines_of(const velocity_grid& grid, const fluid_state& state) {
  const int d = grid.dimensions(), last = grid.last_component();
  const velocity_line& line = grid.last_line();
  target_rows::lines_of_row of{d,  last,          {}, line.points(), grid.lines(), line.v().data(),
                               {}, state.u[last], {}};
  for (int k = 0; k + 1 < d; ++k) {
    of.across[k] = grid.component_across(k);
    of.v_across[k] = grid.component_of_lines(k);
    of.u_across[k] = state.u[of.across[k]];
  }
  return of;
}

/// Returns body(constant), where the constant is the number of dimensions at compile time.
template <class Body>
bool with_dimensions(int dimensions, const Body& body) {
  switch (dimensions) {
    case 1:
      return body(std::integral_constant<int, 1>());
    case 2:
      return body(std::integral_constant<int, 2>());
    default:
      return body(std::integral_constant<int, 3>());
  }
}

using scalar::target_defect;

/// Largest accepted defect of momentum or energy. The energy may be a difference of large numbers.
constexpr double largest_bound = 1e-12;

/// Returns the square of the largest distance between neighbouring velocities within a thermal speed √T of u.
/// It is Δv² on uniform lines.
double widest_gap(const velocity_grid& grid, const fluid_state& state) {
  if (grid.is_polar()) return gap_square_on_rings(grid, state);
  double widest = 0.0;
  for (int k = 0; k < grid.dimensions(); ++k) {
    const velocity_line& line = grid.line(k);
    const double width = std::sqrt(state.T);
    widest = std::max(
        widest, line.uniform() ? line.spacing() : line.widest_gap(state.u[k] - width, state.u[k] + width));
  }
  return widest * widest;
}

target_defect defect_of(const double* after, const double* omega, const fluid_state& state, int d,
                        double variance) {
  target_defect found;
  const double speed = std::sqrt(variance);
  const double mass = after[0] - omega[0];
  double energy = after[d + 1] - omega[d + 1];
  for (int k = 0; k < d; ++k) {
    const double momentum = after[k + 1] - omega[k + 1];
    found.momentum[k] = (momentum - state.u[k] * mass) / (omega[0] * speed);
    energy -= state.u[k] * (momentum - 0.5 * state.u[k] * mass);
  }
  found.mass = mass / omega[0];
  found.energy = energy / (omega[0] * variance);
  return found;
}

/// Returns the ratio of the total energy to that of the base. The defect of the energy is a difference to the
/// energy of the bulk velocity, so that its rounding error grows with this ratio.
double energy_ratio(const double* omega, int d, double variance) {
  return std::max(1.0, omega[d + 1] / (omega[0] * variance));
}

/// Whether the moments have the accuracy of targets. `ratio` enlarges the bounds for a moving gas.
bool is_accurate(const target_defect& found, double ratio) {
  return std::abs(found.mass) <= target_accuracy &&
         found.largest_momentum() <= std::min(target_accuracy * std::sqrt(ratio), largest_bound) &&
         std::abs(found.energy) <= std::min(target_accuracy * ratio, largest_bound);
}

/// Corrects the shape by moments of the base, without a pass over the target. Returns false if that is
/// not possible.
bool correct_by_moments(const gas& of, const fluid_state& state, const target_base& base,
                        target_shape& shape) {
  if (base.moments.known)
    return with_dimensions(of.dimensions(), [&](auto d) {
      return scalar::moments_of_product<d.value>(base.moments).correct(shape);
    });
  if (!shape.of_g.is_quadratic() || !shape.of_h.is_quadratic() || (of.reduced() && !(base.others > 0.0)))
    return false;
  const central_sums sums(of.grid(), base.row, state.u, central_sums::highest_degree);
  const scalar::base_contents contents{state.rho, base.others, of.degrees_of_freedom() * state.T};
  return with_dimensions(of.dimensions(), [&](auto d) {
    return scalar::moments_of_base<d.value, central_sums>{sums, contents}.correct(shape);
  });
}

}  // namespace

central_moments compute_central_moments(const gas& of, const double* row, const fluid_state& state) {
  const velocity_grid& grid = of.grid();
  const auto d = static_cast<std::size_t>(grid.dimensions());
  const central_sums g(grid, row, state.u, 3);
  central_moments all;
  for (std::size_t k = 0; k < d; ++k)
    for (std::size_t l = 0; l < d; ++l) all.stress[k][l] = g.along({k, l}) / state.rho;
  const auto third = [&g](int k, int l) {
    const auto i = static_cast<std::size_t>(k), j = static_cast<std::size_t>(l);
    return g.along({i, j, j});
  };
  const auto find_heat = [&](const auto& of_h) {
    scalar::find_heat_flux(grid.dimensions(), third, of_h, all.heat.data());
  };
  if (of.reduced()) {
    const central_sums h(grid, row + grid.size(), state.u, 1);
    find_heat([&h](int k) { return h.along({static_cast<std::size_t>(k)}); });
  } else {
    find_heat([](int) { return 0.0; });
  }
  return all;
}

std::array<std::array<double, 3>, 3> compute_stress(const gas& of, const double* row,
                                                    const fluid_state& state) {
  const auto d = static_cast<std::size_t>(of.dimensions());
  const central_sums g(of.grid(), row, state.u, 2);
  std::array<std::array<double, 3>, 3> stress{};
  for (std::size_t k = 0; k < d; ++k)
    for (std::size_t l = 0; l < d; ++l) stress[k][l] = g.along({k, l}) / state.rho;
  return stress;
}

bool conservative_target(const gas& of, const double* omega, const target_base& base,
                         const target_shape& given, const double* f, double keep, double* e, bool& raised) {
  const velocity_grid& grid = of.grid();
  const int d = grid.dimensions();
  const fluid_state state = of.state(omega);
  target_shape shape = given;
  if (!(shape.variance >= scalar::narrowest_target * widest_gap(grid, state))) return false;
  const bool corrected = correct_by_moments(of, state, base, shape);
  const target_rows::lines_of_row lines = lines_of(grid, state);
  const int of_h = of.reduced() ? grid.size() : 0;
  const double* from = base.row;
  const auto weigh_all = [&](bool with_h) {
    bool some = target_rows::weigh(from, shape.of_g, lines, f, keep, e);
    if (of.reduced() && with_h)
      some |= target_rows::weigh(from + of_h, shape.of_h, lines, f + of_h, keep, e + of_h);
    raised |= some;
    return some;
  };
  if (corrected && !weigh_all(true)) return true;
  thread_local aligned_vector<double> again;
  if (from == e) {
    again.resize(static_cast<std::size_t>(grid.size() + of_h));
    base.fill(again.data());
    from = again.data();
  }
  // If the base is not a Gaussian, each correction reduces the defect about tenfold. Once corrections no
  // longer reduce it, target_accuracy is enough.
  const double ratio = energy_ratio(omega, d, shape.variance),
               enough = std::min(scalar::target_rounding * ratio, largest_bound);
  double best = 1e300;
  bool cut = false;
  // A target that is cut off and needs many corrections is far from the published one. A smaller part may
  // need no cut.
  const auto most_corrections = [&cut] { return cut ? 12 : 40; };
  for (int iteration = 0; iteration < most_corrections(); ++iteration) {
    cut |= weigh_all(iteration == 0);
    std::array<double, 5> after{};
    of.moments(e, 0, 1, after.data());
    const target_defect found = defect_of(after.data(), omega, state, d, shape.variance);
    const double size = found.size();
    if (size <= enough) return true;
    // Corrections contract as long as little of the row is cut off. Once the defect is a rounding error, it
    // varies from one correction to the next.
    if (!(size < 0.7 * best)) {
      if (is_accurate(found, ratio)) return true;
      if (!(size <= largest_bound)) return false;
    }
    if (iteration + 1 >= most_corrections()) return is_accurate(found, ratio);
    best = size;
    scalar::correction_of(found, d, shape.variance).add_to(shape.of_g, d);
  }
  return false;
}

}  // namespace apsis
