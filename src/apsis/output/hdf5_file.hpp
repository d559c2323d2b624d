#pragma once

#include <apsis/exec/communicator.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// Storage type of numbers.
enum class precision { float64, float32 };

/// The part of a dataset that one of several processes holds: indices first … first + count − 1 of each
/// extent.
struct dataset_part {
  std::vector<std::uint64_t> first;  ///< first index of each extent
  std::vector<std::uint64_t> count;  ///< number of indices; 0 if the process holds nothing
};

/// An HDF5 file with the operations that results need. The destructor closes identifiers. Objects carry no
/// time stamps, so that equal results give equal bytes. HDF5 does not print errors itself. Every member
/// throws io_error with the name of the file. While one thread has a file open, other threads wait, because
/// not every build of HDF5 is thread-safe.
class hdf5_file {
 public:
  using shape = std::vector<std::uint64_t>;  ///< extents of a dataset, the last index running fastest

  /// Creates a file. Its user block of `free_bytes` at the beginning is left to the caller. `free_bytes` is
  /// 0, or a power of two of at least 512.
  static hdf5_file create(const std::string& path, std::uint64_t free_bytes = 0);
  /// Creates a file in which write_part() only reserves space.
  static hdf5_file create_frame(const std::string& path, std::uint64_t free_bytes);
  /// Opens a file of create_frame() after it was closed. write_part() then writes its numbers; other members
  /// write nothing. Several processes may do so simultaneously. `process` describes this one in messages
  /// ("process 1 on node7").
  static hdf5_file open_parts(const std::string& path, const std::string& process);
  /// Opens an existing file for reading.
  static hdf5_file open(const std::string& path);
  ~hdf5_file();
  /// Leaves `other` without a file.
  hdf5_file(hdf5_file&& other) noexcept;
  hdf5_file& operator=(hdf5_file&&) = delete;

  /// Writes a dataset; parent groups of `name` ("fields/rho") are created as needed. Its attributes are
  /// "units" and, if given, "long_name".
  void write(const std::string& name, const std::vector<double>& values, const shape& extents,
             const std::string& long_name = "", precision stored = precision::float64,
             const std::string& units = "dimensionless");
  /// Writes a dataset from the parts of all processes. `values` has the extents part.count; a part
  /// may have no numbers.
  void write_part(const std::string& name, const std::vector<double>& values, const shape& extents,
                  const dataset_part& part, const std::string& long_name = "",
                  precision stored = precision::float64, const std::string& units = "dimensionless");
  /// Writes text as a scalar UTF-8 dataset without attributes.
  void write(const std::string& name, const std::string& text);
  /// Writes a number as an attribute of the file.
  void write_attribute(const std::string& name, double value);
  /// Writes text as an attribute of the file.
  void write_attribute(const std::string& name, const std::string& value);
  /// Returns whether members other than write_part() write.
  bool writes_frame() const { return content_ != content::parts; }
  /// Flushes the file to disk and closes it, so that a full disk is reported here and not in a destructor.
  void close();

  /// Returns whether a dataset or group of this name exists.
  bool has(const std::string& name) const;
  /// Returns whether the file has an attribute of this name.
  bool has_attribute(const std::string& name) const;
  /// Returns the extents of a dataset; empty for a scalar.
  shape extents(const std::string& name) const;
  /// Returns the storage type of a dataset.
  precision stored(const std::string& name) const;
  /// Returns the attribute "units" of a dataset; "" if it has none.
  std::string units(const std::string& name) const;
  /// Returns all numbers of a dataset in row-major order, expanded if they are compressed. Throws if the
  /// dataset is incomplete, its numbers lie in other files, or they do not fit into memory.
  std::vector<double> read(const std::string& name) const;
  /// Returns the numbers of a part of a dataset in row-major order. Throws if the dataset is incomplete.
  std::vector<double> read_part(const std::string& name, const dataset_part& part) const;
  /// Returns text written by write().
  std::string read_text(const std::string& name) const;
  /// Returns a number from the attributes of the file.
  double read_attribute(const std::string& name) const;
  /// Returns the sorted names of all datasets, with the path of their groups ("fields/rho"). Links to groups
  /// are not followed.
  std::vector<std::string> datasets() const;
  /// Returns the sorted names of the datasets of real numbers in a group, or without a name in the file
  /// itself. Linked datasets are included. Texts, other objects and dangling links are omitted.
  std::vector<std::string> number_sets(const std::string& group = "") const;
  /// Returns text from the attributes of the file.
  std::string read_text_attribute(const std::string& name) const;
  /// Returns all numbers among the attributes of the file, by name.
  std::vector<std::pair<std::string, double>> attributes() const;

 private:
  enum class content { all, frame, parts };
  explicit hdf5_file(std::string path, content written = content::all);
  static hdf5_file create(const std::string& path, std::uint64_t free_bytes, content written);
  void write_numbers(const std::string& name, const double* values, const shape& extents,
                     const dataset_part* part, const std::string& long_name, precision stored,
                     const std::string& units);
  void write_reserved(const std::string& name, const double* values, const dataset_part* part);
  void check_numbers(const std::string& name, std::int64_t data, std::uint64_t count) const;
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_to_write(const std::string& what) const;

  std::unique_lock<std::recursive_mutex> access_;  ///< released last
  std::string path_;
  std::int64_t id_ = -1;
  std::unique_ptr<int> error_ = std::make_unique<int>(0);  ///< errno of the first write that failed
  content content_;                                        ///< content that this object writes
  std::string process_;                                    ///< description of the process that writes parts
};

/// Returns the version of the HDF5 library, "1.10.8". Waits while another thread uses the library.
std::string hdf5_version();

/// Writes a file by all processes: the root writes the frame, then each process its parts. `contents` calls
/// the members that write. It runs on every process, and twice on the root. Neither HDF5 nor `contents`
/// communicates, so that no process waits for one that cannot write. If one process throws, all throw.
/// Collective; a single process may be nullptr.
void write_hdf5(const std::string& path, std::uint64_t free_bytes,
                const std::shared_ptr<communicator>& processes,
                const std::function<void(hdf5_file&)>& contents);

}  // namespace apsis
