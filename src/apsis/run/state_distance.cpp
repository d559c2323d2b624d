#include <apsis/run/state_distance.hpp>

#include <apsis/device/row_checks.hpp>
#include <apsis/exec/global_sum.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/scheme/row_check.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace apsis {

namespace {

std::vector<row_squares> squares_on_host(const field& u, const field& v) {
  std::vector<row_squares> squares(static_cast<std::size_t>(u.cells()));
  constexpr int block = 16;
  const loops_over numbers(u.size());
  parallel_blocks(u.cells(), block, [&](int begin, int end) {
    for (int cell = begin; cell < end; ++cell)
      squares[static_cast<std::size_t>(cell)] = compute_squares(u.row(cell), v.row(cell), u.components());
  });
  return squares;
}

}  // namespace

double relative_distance(const field& u, const field& v, communicator& processes, device* on) {
  std::array<exact_sum, 2> sums;
  for (const row_squares& here : on != nullptr ? compute_squares(*on, u, v) : squares_on_host(u, v)) {
    sums[0].add(here.difference);
    sums[1].add(here.size);
  }
  const std::vector<double> all = global_values(processes, sums);
  return all[0] == 0.0 ? 0.0 : std::sqrt(all[0] / all[1]);
}

}  // namespace apsis
