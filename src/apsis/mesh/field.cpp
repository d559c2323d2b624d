#include <apsis/mesh/field.hpp>

#include <apsis/exec/parallel.hpp>

#include <cstddef>
#include <limits>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

namespace apsis {

std::size_t field::numbers(int cells, int stride) {
  const auto rows = static_cast<std::size_t>(cells), width = static_cast<std::size_t>(stride);
  constexpr std::size_t most =
      static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()) / sizeof(double);
  if (width > 0 && rows > most / width) throw std::bad_alloc();
  return rows * width;
}

namespace {

/// Calls work(first number, count) for parts of all rows. On the host these are the parts of all other loops
/// over cells, because the core that first writes a page is near its memory. In other memory there is one
/// call for all rows.
template <class Work>
void for_parts(const field& of, const Work& work) {
  if (!of.memory().on_host()) {
    work(std::size_t{0}, of.size());
    return;
  }
  constexpr int block = 4096;
  const loops_over numbers(of.size());
  const auto width = static_cast<std::size_t>(of.stride());
  parallel_blocks(of.cells(), block, [&](int begin, int end) {
    work(static_cast<std::size_t>(begin) * width, static_cast<std::size_t>(end - begin) * width);
  });
}

}  // namespace

void field::clear() {
  for_parts(*this,
            [&](std::size_t first, std::size_t count) { memory().clear(data_.data() + first, count); });
}

void field::copy_numbers(const field& other) {
  for_parts(*this, [&](std::size_t first, std::size_t count) {
    memory().copy(other.data_.data() + first, count, data_.data() + first);
  });
}

void field::copy_rows(const field& from) {
  if (from.cells_ != cells_ || from.components_ != components_) {
    throw std::invalid_argument(fmt::format("rows of {} x {} numbers cannot be copied into {} x {}",
                                            from.cells_, from.components_, cells_, components_));
  }
  const memory_space &here = memory(), &there = from.memory();
  if (&here == &there) {
    copy_numbers(from);
  } else if (there.on_host()) {
    here.copy_from_host(from.data_.data(), size(), data_.data());
  } else if (here.on_host()) {
    there.copy_to_host(from.data_.data(), size(), data_.data());
  } else {  // between two devices, by way of the host
    field between(cells_, components_);
    between.copy_rows(from);
    copy_rows(between);
  }
}

}  // namespace apsis
