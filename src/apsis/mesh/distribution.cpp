#include <apsis/mesh/distribution.hpp>

#include <apsis/core/index.hpp>

#include <array>

namespace apsis {

int distribution::holder(int cell) const {
  std::array<int, 3> place{};
  for (int k = 0; k < 3; ++k) place[at(k)] = blocks.block_of(k, cell / whole.stride(k) % whole.cells(k));
  return blocks.rank(place);
}

int distribution::number_in_block(int cell) const {
  const cell_box box = blocks.box(processes->rank());
  int number = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = cell / whole.stride(k) % whole.cells(k) - box.first[at(k)];
    if (i < 0 || i >= box.cells[at(k)]) return -1;
    number = number * box.cells[at(k)] + i;
  }
  return number;
}

}  // namespace apsis
