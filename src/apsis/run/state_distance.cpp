#include <apsis/run/state_distance.hpp>

#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/parallel.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace apsis {

double relative_distance(const field& u, const field& v, communicator& processes) {
  struct cell_squares {
    double difference = 0.0, size = 0.0;
  };
  std::vector<cell_squares> squares(static_cast<std::size_t>(u.cells()));
  constexpr int block = 16;
  const loops_over numbers(u.size());
  parallel_blocks(u.cells(), block, [&](int begin, int end) {
    for (int cell = begin; cell < end; ++cell) {
      cell_squares& here = squares[static_cast<std::size_t>(cell)];
      for (int k = 0; k < u.components(); ++k) {
        const double x = u.row(cell)[k], d = x - v.row(cell)[k];
        here.difference += d * d;
        here.size += x * x;
      }
    }
  });
  std::array<exact_sum, 2> sums;
  for (const cell_squares& here : squares) {
    sums[0].add(here.difference);
    sums[1].add(here.size);
  }
  const std::vector<double> all = global_values(processes, sums);
  return all[0] == 0.0 ? 0.0 : std::sqrt(all[0] / all[1]);
}

}  // namespace apsis
