#pragma once

#include <cstddef>
#include <string_view>

namespace apsis {

/// Memory in which arrays of numbers live: that of the host, or that of a device. A space lives as long as
/// the program, and is compared by its address. Only code that runs where the memory lies may follow pointers
/// into it. All other code uses these functions.
class memory_space {
 public:
  memory_space() = default;
  memory_space(const memory_space&) = delete;             ///< not copyable
  memory_space& operator=(const memory_space&) = delete;  ///< not copyable
  virtual ~memory_space() = default;

  /// Name for messages.
  virtual std::string_view name() const = 0;
  /// Whether code of the host may follow pointers into this space.
  virtual bool on_host() const = 0;
  /// Returns `count` uninitialized numbers on an address divisible by `alignment`. Throws std::bad_alloc.
  virtual double* allocate(std::size_t count) const = 0;
  /// Releases what allocate(count) returned.
  virtual void release(double* numbers, std::size_t count) const noexcept = 0;
  /// Sets `count` numbers of this space to 0.
  virtual void clear(double* numbers, std::size_t count) const = 0;
  /// Copies `count` numbers within this space; the two ranges do not overlap.
  virtual void copy(const double* from, std::size_t count, double* to) const = 0;
  /// Copies `count` numbers of the host into this space.
  virtual void copy_from_host(const double* host, std::size_t count, double* to) const = 0;
  /// Copies `count` numbers of this space to the host.
  virtual void copy_to_host(const double* from, std::size_t count, double* host) const = 0;
};

/// Returns the memory of the host. allocate() does not write to it: each page lies near the core of the
/// thread that first writes it.
const memory_space& host_memory();

/// Numbers in a memory space, released with the object that owns them.
class stored_numbers {
 public:
  stored_numbers() = default;
  /// Allocates `count` uninitialized numbers. Throws std::bad_alloc.
  stored_numbers(std::size_t count, const memory_space& space);
  stored_numbers(const stored_numbers&) = delete;              ///< not copyable
  stored_numbers& operator=(const stored_numbers&) = delete;   ///< not copyable
  stored_numbers(stored_numbers&& other) noexcept;             ///< leaves the source empty
  stored_numbers& operator=(stored_numbers&& other) noexcept;  ///< leaves the source empty
  ~stored_numbers();

  double* data() { return data_; }                       ///< first number, null if empty
  const double* data() const { return data_; }           ///< first number, null if empty
  std::size_t size() const { return count_; }            ///< how many numbers
  const memory_space& space() const { return *space_; }  ///< memory space of the numbers

 private:
  const memory_space* space_ = &host_memory();
  double* data_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace apsis
