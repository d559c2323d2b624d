#include <apsis/device/internal/swept_segments.hpp>

#include <apsis/device/internal/row_launch.hpp>

#include <algorithm>
#include <vector>

namespace apsis {

swept_segments::swept_segments(device& on, const domain& space, const surface_rows& surfaces, int direction,
                               int halo, int ghosts)
    : device_(on), apart_(space.mesh().stride(direction)), ghosts_(ghosts) {
  // Each piece recomputes the edges of a few cells. Short pieces keep more multiprocessors busy.
  constexpr int longest = 32;
  std::vector<kernels::swept_segment> segments;
  std::vector<kernels::piece_of_segment> pieces;
  std::vector<int> beyond;
  const int count = static_cast<int>(space.segments().along(direction).size());
  for (int number = 0; number < count; ++number) {
    const segment& one = space.segment_at(direction, number);
    kernels::swept_segment made{one.first, one.cells, {}, {}};
    for (const bool upper : {false, true}) {
      const std::size_t side = upper ? 1 : 0;
      made.seen[side] = surfaces.seen_beyond(direction, number, upper, halo);
      made.rows[side] = surfaces.row_at_end(direction, number, upper);
      // Beyond a surface that prescribes incoming components, fluxes see vacuum.
      for (int distance = 0; distance < ghosts; ++distance)
        beyond.push_back(distance < made.seen[side] + ghosts - halo
                             ? surfaces.row_beyond_end(direction, number, upper, distance)
                             : kernels::row_beyond::nothing);
    }
    segments.push_back(made);
    for (int begin = 0; begin < one.cells; begin += longest)
      pieces.push_back({number, begin, std::min(begin + longest, one.cells)});
  }
  pieces_count_ = static_cast<int>(pieces.size());
  segments_ = device_array<kernels::swept_segment>(segments, device_.memory());
  pieces_ = device_array<kernels::piece_of_segment>(pieces, device_.memory());
  beyond_ = device_array<int>(beyond, device_.memory());
}

void swept_segments::set_speeds(const line_speeds& of) {
  per_cell_ = device_array<double>(of.per_cell, device_.memory());
  forward_ = device_array<double>(of.forward, device_.memory());
  inverse_cfl_ = device_array<double>(of.inverse_cfl, device_.memory());
}

void swept_segments::sweep(const std::string& kernel, kernels::sweep_arguments arguments) const {
  if (pieces_count_ == 0) return;
  arguments.per_cell = per_cell_.data();
  arguments.forward = forward_.data();
  arguments.inverse_cfl = inverse_cfl_.data();
  arguments.segments = segments_.data();
  arguments.pieces = pieces_.data();
  arguments.beyond = beyond_.data();
  arguments.ghosts = ghosts_;
  arguments.apart = apart_;
  // Processors run lanes in groups of 32.
  constexpr long group = 32;
  const int lanes =
      static_cast<int>(std::min<long>(independent_lanes, (arguments.stride + group - 1) / group * group));
  arguments.columns = static_cast<int>((arguments.stride + lanes - 1) / lanes);
  device_.start(kernel, {pieces_count_ * arguments.columns, lanes, 0}, &arguments, sizeof arguments);
}

}  // namespace apsis
