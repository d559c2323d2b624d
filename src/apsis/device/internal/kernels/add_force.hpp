#pragma once

#include <apsis/device/internal/gas_rows.hpp>
#include <apsis/semidiscrete/formulas/lattice.hpp>

namespace apsis::kernels {

/// acc ← acc + β (−a·∇_v u), as force::add(), with eight lanes for each cell. Each lane walks along its
/// own lines.
struct add_force {
  static constexpr const char* name = "add_force";  ///< name of the kernel
  static constexpr int most_targets = 8;            ///< largest number of targets
  static constexpr int lanes = 128;                 ///< lanes of a block
  static constexpr int cells = lanes / 8;           ///< cells of a block

  /// The rows along a direction of the lattice (lattice_rows::layout).
  struct direction {
    int blocks, points, apart;
    double spacing;  ///< Δv
  };
  /// A target.
  struct target {
    double* acc;  ///< rows of all cells
    double beta;  ///< factor of T
  };

  /// Arguments.
  struct arguments {
    const double *u,           ///< rows of all cells
        *a,                    ///< three components of the acceleration in every cell
        *weights;              ///< weights of all velocities
    double *room,              ///< numbers_of_room() for each cell of a launch
        *sums;                 ///< sums of every cell: invariants given, invariants of u, mass into the
                               ///< last points
    gas_rows rows;             ///< rows of the gas
    direction along[3];        ///< directions of the velocities
    long stride;               ///< numbers of a row
    double inverse_cfl;        ///< 1/C of limited fluxes
    int first, last,           ///< cells first … last − 1
        components,            ///< components of a row
        most_lines,            ///< most lines of a direction
        fifth_order, limited,  ///< rule of fluxes
        targets;               ///< number of targets
    target to[most_targets];   ///< targets
  };

  /// Returns how many numbers of `room` a cell needs: the change of a row, and fluxes into the last points
  /// of lines.
  static constexpr APSIS_FORMULA long numbers_of_room(int components, int most_lines) {
    return static_cast<long>(components) + most_lines;
  }

  /// Adds the force in a cell, together with seven other lanes. The block has shared memory for most_totals
  /// numbers per lane.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    with_dimensions(of.rows.dimensions,
                    [&](auto dimensions) APSIS_INLINED { add<decltype(dimensions)::value>(lane, of); });
  }

 private:
  template <int Dimensions, class Lane>
  static APSIS_FORMULA void add(const Lane& lane, const arguments& of) {
    const lane_group<Lane> group{lane, lane.shared()};
    const int place = of.first + group.number_in_launch();
    const bool counts = place < of.last;
    const int cell = counts ? place : of.last - 1;
    const double* u = of.u + cell * of.stride;
    double* change = of.room + group.number_in_launch() * numbers_of_room(of.components, of.most_lines);
    double* into_last = change + of.components;
    bool fresh = true;
    double held = 0.0;
    for (int k = 0; k < Dimensions; ++k) {
      const double a = of.a[3l * cell + k], rate = __builtin_fabs(a) / of.along[k].spacing;
      if (a != 0.0) {
        for (int line = group.place(); line < of.along[k].blocks * of.along[k].apart; line += 8)
          into_last[line] = walk(of, of.along[k], line, a > 0.0, rate, fresh, u, change);
      }
      lane.wait();
      if (a != 0.0) held += rate * mass_into_ends(of, of.along[k], a > 0.0, into_last);
      if (a != 0.0) fresh = false;
      lane.wait();
    }
    double given[Dimensions + 2], own[Dimensions + 2];
    of.rows.moments<Dimensions>(group, change, given);
    of.rows.moments<Dimensions>(group, u, own);
    if (!counts) return;
    if (group.place() == 0) {
      double* sums = of.sums + static_cast<long>(cell) * (2 * Dimensions + 5);
      for (int k = 0; k < Dimensions + 2; ++k) {
        sums[k] = fresh ? 0.0 : given[k];
        sums[Dimensions + 2 + k] = own[k];
      }
      sums[2 * Dimensions + 4] = held;
    }
    if (fresh) return;
    for (int n = 0; n < of.targets; ++n) {
      double* acc = of.to[n].acc + cell * of.stride;
      for (int j = group.place(); j < of.components; j += 8)
        acc[j] = scalar::with_change(acc[j], of.to[n].beta, change[j]);
    }
  }

  /// The values of a line in the direction of motion.
  struct values_along {
    const double* first;
    long step;
    int points;
    APSIS_FORMULA double operator()(int j) const { return j < 0 || j >= points ? 0.0 : first[j * step]; }
  };

  /// Adds the differences of fluxes along a line to the change of the row. Returns the flux into the
  /// last point.
  static APSIS_FORMULA double walk(const arguments& of, const direction& along, int line, bool forward,
                                   double rate, bool fresh, const double* row, double* change) {
    const long at = static_cast<long>(line / along.apart) * along.points * along.apart + line % along.apart +
                    (forward ? 0l : static_cast<long>(along.points - 1) * along.apart);
    const long step = forward ? along.apart : -along.apart;
    const values_along values{row + at, step, along.points};
    double* sum = change + at;
    const auto put = [&](double difference) APSIS_INLINED {
      *sum = scalar::fma(rate, difference, fresh ? 0.0 : *sum);
      sum += step;
    };
    using scalar::add_fluxes;
    if (of.limited != 0)
      return of.fifth_order != 0 ? add_fluxes<true, true>(values, along.points, of.inverse_cfl, put)
                                 : add_fluxes<true, false>(values, along.points, of.inverse_cfl, put);
    return of.fifth_order != 0 ? add_fluxes<false, true>(values, along.points, of.inverse_cfl, put)
                               : add_fluxes<false, false>(values, along.points, of.inverse_cfl, put);
  }

  /// Returns the mass that enters the last points, as force::mass_into_ends() does.
  static APSIS_FORMULA double mass_into_ends(const arguments& of, const direction& along, bool forward,
                                             const double* into_last) {
    const int block_size = along.points * along.apart, last = forward ? block_size - along.apart : 0;
    double mass = 0.0;
    for (int block = 0; block * block_size < of.rows.size; ++block)
      for (int k = 0; k < along.apart; ++k)
        mass += of.weights[block * block_size + last + k] * into_last[block * along.apart + k];
    return mass;
  }
};

}  // namespace apsis::kernels
