#include <apsis/mesh/field.hpp>

#include <apsis/exec/parallel.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <new>

namespace apsis {

std::size_t field::numbers(int cells, int stride) {
  const auto rows = static_cast<std::size_t>(cells), width = static_cast<std::size_t>(stride);
  constexpr std::size_t most =
      static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / sizeof(double);
  if (width > 0 && rows > most / width) throw std::bad_alloc();
  return rows * width;
}

void field::fill_rows(const double* values) {
  // In the parts of all other loops over cells: memory is near to the core that writes it first.
  constexpr int block = 4096;
  const loops_over numbers(size());
  parallel_blocks(cells_, block, [&](int begin, int end) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(begin) * stride_,
                         count = static_cast<std::ptrdiff_t>(end - begin) * stride_;
    if (values == nullptr) {
      std::fill_n(data_.data() + first, count, 0.0);
    } else {
      std::copy_n(values + first, count, data_.data() + first);
    }
  });
}

}  // namespace apsis
