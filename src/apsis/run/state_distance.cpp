#include <apsis/run/state_distance.hpp>

#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/mesh/on_host.hpp>
#include <apsis/scheme/row_check.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace apsis {

double relative_distance(const field& one, const field& other, communicator& processes) {
  field room, other_room;
  const field &u = on_host(one, room), &v = on_host(other, other_room);
  std::vector<row_squares> squares(static_cast<std::size_t>(u.cells()));
  constexpr int block = 16;
  const loops_over numbers(u.size());
  parallel_blocks(u.cells(), block, [&](int begin, int end) {
    for (int cell = begin; cell < end; ++cell)
      squares[static_cast<std::size_t>(cell)] = compute_squares(u.row(cell), v.row(cell), u.components());
  });
  std::array<exact_sum, 2> sums;
  for (const row_squares& here : squares) {
    sums[0].add(here.difference);
    sums[1].add(here.size);
  }
  const std::vector<double> all = global_values(processes, sums);
  return all[0] == 0.0 ? 0.0 : std::sqrt(all[0] / all[1]);
}

}  // namespace apsis
