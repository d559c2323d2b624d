#include <apsis/exec/memory_space.hpp>

#include <apsis/exec/aligned.hpp>

#include <algorithm>
#include <memory>
#include <utility>

#include <sys/mman.h>

namespace apsis {

namespace {

/// Asks the system for pages of 2 MiB, because one of them costs about as much to take as one of 4 KiB. The
/// system may ignore the advice.
void advise_huge_pages(void* memory, std::size_t bytes) {
  constexpr std::size_t huge = std::size_t{2} << 20;
  void* first = memory;
  if (bytes < 2 * huge || std::align(huge, huge, first, bytes) == nullptr) return;
  madvise(first, bytes / huge * huge, MADV_HUGEPAGE);
}

class host final : public memory_space {
 public:
  std::string_view name() const override { return "host"; }
  bool on_host() const override { return true; }
  double* allocate(std::size_t count) const override {
    double* numbers = aligned_allocator<double>().allocate(count);
    advise_huge_pages(numbers, count * sizeof(double));
    return numbers;
  }
  void release(double* numbers, std::size_t count) const noexcept override {
    aligned_allocator<double>().deallocate(numbers, count);
  }
  void clear(double* numbers, std::size_t count) const override { std::fill_n(numbers, count, 0.0); }
  void copy(const double* from, std::size_t count, double* to) const override {
    std::copy_n(from, count, to);
  }
  void copy_from_host(const double* from, std::size_t count, double* to) const override {
    std::copy_n(from, count, to);
  }
  void copy_to_host(const double* from, std::size_t count, double* to) const override {
    std::copy_n(from, count, to);
  }
};

}  // namespace

const memory_space& host_memory() {
  static const host only;
  return only;
}

stored_numbers::stored_numbers(std::size_t count, const memory_space& space)
    : space_(&space), data_(count > 0 ? space.allocate(count) : nullptr), count_(count) {}

stored_numbers::stored_numbers(stored_numbers&& other) noexcept
    : space_(other.space_),
      data_(std::exchange(other.data_, nullptr)),
      count_(std::exchange(other.count_, 0)) {}

stored_numbers& stored_numbers::operator=(stored_numbers&& other) noexcept {
  std::swap(space_, other.space_);
  std::swap(data_, other.data_);
  std::swap(count_, other.count_);
  const stored_numbers released = std::move(other);  // what this object owned
  return *this;
}

stored_numbers::~stored_numbers() {
  if (data_ != nullptr) space_->release(data_, count_);
}

}  // namespace apsis
