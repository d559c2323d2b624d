// Storage of rows: padding, alignment, copies, and memory of a device.
#include <apsis/mesh/field.hpp>

#include <apsis/exec/aligned.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <new>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>
#include <sys/mman.h>

namespace field_test {

using apsis::field;

namespace {

/// Pages that only the functions of this space can read and write. Any other access ends with a segmentation
/// fault, as with memory of a device.
class locked_memory : public apsis::memory_space {
 public:
  ~locked_memory() override { EXPECT_TRUE(sizes_.empty()) << "numbers were not released"; }
  std::string_view name() const override { return "locked"; }
  bool on_host() const override { return false; }
  double* allocate(std::size_t count) const override {
    void* pages = mmap(nullptr, bytes(count), PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED) throw std::bad_alloc();
    sizes_[static_cast<double*>(pages)] = count;
    return static_cast<double*>(pages);
  }
  void release(double* numbers, std::size_t count) const noexcept override {
    EXPECT_EQ(sizes_.at(numbers), count);
    sizes_.erase(numbers);
    munmap(numbers, bytes(count));
  }
  void clear(double* numbers, std::size_t count) const override {
    unlocked([&] { std::fill_n(numbers, count, 0.0); });
  }
  void copy(const double* from, std::size_t count, double* to) const override {
    unlocked([&] { std::copy_n(from, count, to); });
  }
  void copy_from_host(const double* from, std::size_t count, double* to) const override {
    copy(from, count, to);
  }
  void copy_to_host(const double* from, std::size_t count, double* to) const override {
    copy(from, count, to);
  }

  std::size_t arrays() const { return sizes_.size(); }

 private:
  static std::size_t bytes(std::size_t count) { return count * sizeof(double); }
  template <class Work>
  void unlocked(const Work& work) const {
    for (const auto& [pages, count] : sizes_)
      ASSERT_EQ(mprotect(pages, bytes(count), PROT_READ | PROT_WRITE), 0);
    work();
    for (const auto& [pages, count] : sizes_) ASSERT_EQ(mprotect(pages, bytes(count), PROT_NONE), 0);
  }
  mutable std::map<double*, std::size_t> sizes_;
};

/// Returns a field with signed zeros, subnormal and infinite numbers among others.
field numbered(int cells, int components) {
  field u(cells, components);
  constexpr std::array special = {-0.0, 5e-324, std::numeric_limits<double>::infinity(), -1.0 / 3};
  for (int i = 0; i < cells; ++i) {
    for (int k = 0; k < components; ++k) {
      const auto n = static_cast<std::size_t>(i * components + k);
      u.row(i)[k] = n < special.size() ? special[n] : 1.0 / static_cast<double>(n);
    }
  }
  return u;
}

/// Returns true if two fields on the host have the same bits.
bool same(const field& a, const field& b) {
  return a.cells() == b.cells() && a.components() == b.components() &&
         std::memcmp(a.row(0), b.row(0), a.size() * sizeof(double)) == 0;
}

}  // namespace

TEST(field, pads_rows_of_eight_or_more_numbers_with_zeros_to_cache_lines) {
  for (const int components : {1, 7, 8, 9, 48, 49, 150}) {
    const field u(5, components);
    EXPECT_EQ(u.stride(), components < 8 ? components : (components + 7) / 8 * 8);
    EXPECT_EQ(u.size(), 5U * static_cast<std::size_t>(u.stride()));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(u.row(0)) % apsis::alignment, 0U);
    EXPECT_TRUE(std::all_of(u.row(0), u.row(0) + u.size(), [](double a) { return a == 0.0; }));
  }
}

TEST(field, copies_are_equal_and_independent) {
  const field u = numbered(9000, 9);  // more cells than a part of the copy has
  field copy = u;
  EXPECT_TRUE(same(u, copy));
  copy.row(8999)[8] = 7.0;
  EXPECT_FALSE(same(u, copy));
  const double* const place = copy.row(0);
  copy = u;
  EXPECT_EQ(copy.row(0), place) << "equal sizes need no new memory";
  EXPECT_TRUE(same(u, copy));
  copy = numbered(3, 2);
  EXPECT_TRUE(same(copy, numbered(3, 2)));
  const field moved = std::move(copy);
  EXPECT_TRUE(same(moved, numbered(3, 2)));
}

TEST(field, in_memory_of_a_device_is_filled_copied_and_moved_without_following_its_pointers) {
  const locked_memory device;
  {
    const field u = numbered(9000, 9);
    field there(9000, 9, device), back = numbered(9000, 9);
    EXPECT_EQ(&there.memory(), &device);
    back.copy_rows(there);
    EXPECT_TRUE(same(back, field(9000, 9))) << "a new field is zero";
    there.copy_rows(u);
    const field copy = there;
    EXPECT_EQ(&copy.memory(), &device);
    there = field(9000, 9, device);
    back.copy_rows(copy);
    EXPECT_TRUE(same(back, u));
    back.copy_rows(there);
    EXPECT_TRUE(same(back, field(9000, 9)));
    there = copy;
    const field moved = std::move(there);
    back.copy_rows(moved);
    EXPECT_TRUE(same(back, u));
    EXPECT_EQ(device.arrays(), 2U);
  }
  EXPECT_EQ(device.arrays(), 0U);
}

TEST(field, takes_rows_of_another_device) {
  const locked_memory first, second;
  const field u = numbered(20, 9);
  field a(20, 9, first), b(20, 9, second), back(20, 9);
  a.copy_rows(u);
  b.copy_rows(a);
  back.copy_rows(b);
  EXPECT_TRUE(same(back, u));
  b = u;  // an assignment takes the memory along
  EXPECT_EQ(&b.memory(), &apsis::host_memory());
  EXPECT_EQ(second.arrays(), 0U);
}

TEST(field, refuses_sizes_that_differ_and_sizes_beyond_the_address_space) {
  field u(4, 9);
  EXPECT_THROW(u.copy_rows(field(4, 10)), std::invalid_argument);  // the same stride
  EXPECT_THROW(u.copy_rows(field(5, 9)), std::invalid_argument);
  constexpr int most = std::numeric_limits<int>::max();
  EXPECT_THROW(field(most, most - 7), std::bad_alloc);
}

}  // namespace field_test
