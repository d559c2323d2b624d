#pragma once

#include <apsis/core/relaxation_weights.hpp>
#include <apsis/device/internal/lane_group.hpp>
#include <apsis/model/formulas/relaxation.hpp>
#include <apsis/model/formulas/velocity_line.hpp>

namespace apsis::kernels {

/// Stages of the BGK model whose velocities are an even line: u ← v with v = u + a Q(v)/ε + b Q̇(v)/ε² in
/// every cell, eight lanes for each. Cells whose equilibrium is not the formula are left as they are, and are
/// marked.
struct collide_line {
  static constexpr const char* name = "collide_line";         ///< of the kernel
  static constexpr int longest_chain = 256;                   ///< of velocity_rows
  static constexpr int most_velocities = 16 * longest_chain;  ///< which halves can be

  /// Arguments.
  struct arguments {
    double* u;          ///< rows of all cells
    double* marks;      ///< of every cell: 1 if it is left, else 0
    const double *v,    ///< velocities
        *half_square,   ///< ½v²
        *epsilon;       ///< ε of every cell
    long stride;        ///< numbers of a row
    int first, last;    ///< cells
    int n;              ///< number of velocities
    int any_formula;    ///< whether the formula counts also where its moments are not exact
    int by_viscosity;   ///< whether C = Pr ρ √T instead of 1
    double spacing,     ///< Δv
        weight,         ///< of the sums
        max,            ///< the end of the line
        prandtl, a, b;  ///< Pr, a ≥ 0, b ≤ 0
  };

  /// Lanes of a block.
  static constexpr int lanes = 128;
  /// Cells of a block.
  static constexpr int cells = lanes / 8;

  /// Solves the stage of a cell together with seven other lanes.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    using namespace scalar;
    const lane_group<Lane> group{lane, lane.shared()};
    const int number = of.first + lane.block() * cells + group.group();
    // Lanes behind the last cell take part in the sums.
    const int cell = number < of.last ? number : of.last - 1;
    double* u = of.u + cell * of.stride;
    const moments_of_line sums = moments<4>(group, u, of.v, of.half_square, of.n);
    const state_of_line state =
        state_of_line::of(of.weight * sums.mass, of.weight * sums.momentum, of.weight * sums.energy);
    if (number >= of.last) return;
    const bool kept =
        state.admissible() && (of.any_formula != 0 || gaussian_has_exact_moments(of.spacing, of.max, state));
    if (group.place() == 0) of.marks[cell] = kept ? 0.0 : 1.0;
    if (!kept) return;
    const double rate = of.by_viscosity != 0 ? of.prandtl * state.rho * __builtin_sqrt(state.T) : 1.0;
    const auto weights = relax_weights(of.a, of.b, rate, of.epsilon[cell]);
    fill(group, of, state, [&](int k, double e) {
      const int j = k + group.place();
      if (j >= of.n) return;
      u[j] = weights.of_e <= weights.of_u ? moved_towards(u[j], weights.of_e, e)
                                          : moved_towards(e, weights.of_u, u[j]);
    });
  }

 private:
  /// Halves of halves, at whole cache lines, as velocity_rows::moments().
  template <int Depth, class Group>
  static APSIS_FORMULA scalar::moments_of_line moments(const Group& group, const double* f, const double* v,
                                                       const double* half_square, int n) {
    if constexpr (Depth > 0)
      if (n > longest_chain) {
        const int half = (n / 2 + 7) / 8 * 8;
        const auto before = moments<Depth - 1>(group, f, v, half_square, half),
                   behind = moments<Depth - 1>(group, f + half, v + half, half_square + half, n - half);
        return {before.mass + behind.mass, before.momentum + behind.momentum, before.energy + behind.energy};
      }
    scalar::moments_of_line sums;
    scalar::sum_moments<1>(group, f, 0, v, half_square, n, &sums);
    return sums;
  }

  template <class Group, class Put>
  static APSIS_FORMULA void fill(const Group& group, const arguments& of, const scalar::state_of_line& state,
                                 const Put& put) {
    using namespace scalar;
    const spaced_line line{of.n, of.spacing};
    const gaussian_of_line curve{state.height(), state.u, state.T};
    if (!walks_outwards(line, curve)) return gaussian_by_octets(group, line, curve, put);
    const double per = curve.per();
    const double centre =
        gaussian_vector(curve.u, line.spacing, double(line.n), double(octet_length), double(line.octets()));
    const double x = distances_of_octet(group, line, curve.u, centre);
    const double right = gaussian_right(x, per, line.jump()), change = gaussian_change(per, line.jump());
    walk_outwards(gaussian_outwards<double>{gaussian_start(curve.a, x, per), right, change / right, change},
                  static_cast<int>(centre), line, curve, put);
  }
};

}  // namespace apsis::kernels
