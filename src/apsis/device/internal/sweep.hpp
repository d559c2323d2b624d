#pragma once

#include <apsis/device/internal/lane.hpp>
#include <apsis/semidiscrete/formulas/upwind.hpp>

namespace apsis::kernels {

/// Consecutive cells of a segment, which one block of lanes sweeps along.
struct piece_of_segment {
  int segment,  ///< number of the segment
      begin,    ///< first cell of the piece, counted in the segment
      end;      ///< one past the last one
};

/// A segment of cells with the data that a sweep needs.
struct swept_segment {
  int first,    ///< the first cell
      cells,    ///< number of cells
      seen[2],  ///< cells beyond either end that fluxes depend on
      rows[2];  ///< numbers of the rows that take the upwind values at either end, or −1
};

/// Number of a row beyond the ends of a segment that is neither a row of u nor one of `sent`.
struct row_beyond {
  static constexpr int nothing = -2147483647 - 1;  ///< a row of zeros
};

/// acc ← (fresh ? 0 : acc) + α u + β T. Only the sweep along the first direction adds α u.
struct swept_target {
  double* acc;   ///< rows like those of u
  double alpha,  ///< factor of u
      beta;      ///< factor of T
  int fresh;     ///< whether the old content of acc is ignored
};

/// Arguments of a sweep along one direction.
struct sweep_arguments {
  static constexpr int most_targets = 8;  ///< largest number of targets

  const double* u;                 ///< rows of all cells
  const double* sent;              ///< rows that the host has sent
  double* at_ends;                 ///< rows that take the upwind values at the ends of segments
  const double *per_cell,          ///< |v|/Δx of every component
      *forward,                    ///< 1 if the component moves forward, else 0
      *inverse_cfl;                ///< 1/C of limited fluxes
  const swept_segment* segments;   ///< segments of the direction
  const piece_of_segment* pieces;  ///< one for each block
  const int* beyond;  ///< [segment][end][distance], distance < ghosts: rows beyond the ends: n ≥ 0 is a row
                      ///< of u, −1 − n row n of `sent`; or row_beyond::nothing
  long stride;        ///< numbers of a row with its padding
  int ghosts,         ///< rows beyond each end
      apart,          ///< distance of consecutive cells of a segment
      columns,        ///< blocks that share a piece; each lane sweeps one component
      limited,        ///< whether fluxes are limited
      targets;        ///< number of targets
  swept_target target[most_targets];  ///< targets
};

/// T along one direction, as in semidiscrete/block_sweep.hpp, with one component on each lane.
/// Scheme::edge(a, b, c, d, e) is the downstream edge value of the cell c; a … e are five cells in the
/// direction of motion.
template <class Scheme>
struct sweep {
  using arguments = sweep_arguments;  ///< arguments

  /// Sweeps a component along a piece.
  template <class Lane>
  static APSIS_FORMULA void run(const Lane& lane, const arguments& of) {
    const int k = (lane.block() % of.columns) * lane.count() + lane.index();
    if (k >= of.stride) return;
    const piece_of_segment piece = of.pieces[lane.block() / of.columns];
    const way along(of, piece, k);
    if (of.limited != 0)
      along.limited();
    else
      along.plain();
  }

 private:
  /// The way of a component along a piece. Cell j of the way is the j-th cell in the direction of motion.
  struct way {
    const arguments& of;
    const swept_segment& segment;
    const int* beyond;
    int k, count, start, step;
    double speed, inverse_cfl;

    APSIS_FORMULA way(const arguments& all, const piece_of_segment& piece, int component)
        : of(all),
          segment(all.segments[piece.segment]),
          beyond(all.beyond + static_cast<long>(piece.segment) * 2 * all.ghosts),
          k(component),
          count(piece.end - piece.begin),
          start(all.forward[component] > 0.5 ? piece.begin : piece.end - 1),
          step(all.forward[component] > 0.5 ? 1 : -1),
          speed(all.per_cell[component]),
          inverse_cfl(all.inverse_cfl[component]) {}

    APSIS_FORMULA long offset(int cell) const {
      return (segment.first + static_cast<long>(cell) * of.apart) * of.stride + k;
    }
    APSIS_FORMULA double value(int j) const {
      const int cell = start + step * j;
      if (cell >= 0 && cell < segment.cells) return of.u[offset(cell)];
      const bool upper = cell >= 0;
      const int distance = upper ? cell - segment.cells : -1 - cell;
      // A window is wider than the stencil of a scheme with fewer ghost cells, whose edge ignores this value.
      if (distance >= of.ghosts) return 0.0;
      const int row = beyond[(upper ? of.ghosts : 0) + distance];
      if (row >= 0) return of.u[row * of.stride + k];
      return row == row_beyond::nothing ? 0.0 : of.sent[(-1l - row) * of.stride + k];
    }
    /// Whether fluxes depend on a cell. They treat all other cells as vacuum.
    APSIS_FORMULA bool sees(int j) const {
      const int cell = start + step * j;
      return cell >= -segment.seen[0] && cell < segment.cells + segment.seen[1];
    }
    APSIS_FORMULA void put(int j, double u, double difference) const {
      const long at = offset(start + step * j);
      for (int n = 0; n < of.targets; ++n) {
        const swept_target& to = of.target[n];
        to.acc[at] = scalar::transported(
            to.alpha, u, to.beta * speed, difference, to.fresh != 0, [&] { return to.acc[at]; }, false,
            to.beta, [] { return 0.0; });
      }
    }
    /// Stores the upwind value at a border of cell j, if the segment ends there. The border lies ahead in the
    /// direction of motion, or behind.
    APSIS_FORMULA void keep(int j, bool ahead, double value) const {
      const int cell = start + step * j;
      const bool upper = ahead == (step > 0);
      if (cell != (upper ? segment.cells - 1 : 0)) return;
      const int row = segment.rows[upper ? 1 : 0];
      if (row >= 0) of.at_ends[row * of.stride + k] = value;
    }

    /// Five values in the direction of motion, centred at a cell.
    struct window {
      double a, b, c, d, e;
      APSIS_FORMULA void advance(double next) {
        a = b;
        b = c;
        c = d;
        d = e;
        e = next;
      }
      APSIS_FORMULA double edge() const { return Scheme::edge(a, b, c, d, e); }
    };
    APSIS_FORMULA window at(int j) const {
      return {value(j - 2), value(j - 1), value(j), value(j + 1), value(j + 2)};
    }

    APSIS_FORMULA void plain() const {
      window u = at(-1);
      double in = sees(-1) ? u.edge() : 0.0;
      keep(0, false, in);
      for (int j = 0; j < count; ++j) {
        u.advance(value(j + 2));
        const double out = u.edge();
        put(j, u.c, in - out);
        in = out;
      }
      keep(count - 1, true, in);
    }

    APSIS_FORMULA scalar::limited_cell<double> next(int j, const window& u,
                                                    const scalar::limited_cell<double>& before) const {
      return sees(j) ? scalar::limited_after(before, u.c, u.edge(), inverse_cfl)
                     : scalar::limited_after(before, 0.0, 0.0, inverse_cfl);
    }
    APSIS_FORMULA void limited() const {
      window u = at(-2);
      auto first =
          sees(-2) ? scalar::unlimited(u.c, u.edge(), inverse_cfl) : scalar::unlimited(0.0, 0.0, inverse_cfl);
      u.advance(value(1));
      const auto before = next(-1, u, first);
      u.advance(value(2));
      auto here = next(0, u, before);
      double in = scalar::limited_flux(before, here);
      keep(0, false, in);
      for (int j = 0; j < count; ++j) {
        u.advance(value(j + 3));
        const auto after = next(j + 1, u, here);
        const double out = scalar::limited_flux(here, after);
        put(j, here.u, in - out);
        here = after;
        in = out;
      }
      keep(count - 1, true, in);
    }
  };
};

}  // namespace apsis::kernels
