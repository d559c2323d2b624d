#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace apsis {

/// How numbers are stored.
enum class precision { float64, float32 };

/// An HDF5 file with the few operations that results need. Identifiers are closed by the destructor, objects
/// carry no time stamps (the same results give the same bytes), and HDF5 prints nothing by itself. Everything
/// throws io_error with the name of the file.
class hdf5_file {
 public:
  using shape = std::vector<std::uint64_t>;  ///< extents of a dataset, the last index running fastest

  /// `free_bytes` at the beginning are left to others (the user block): 0 or a power of two from 512 on.
  static hdf5_file create(const std::string& path, std::uint64_t free_bytes = 0);
  /// A file that is there, for reading.
  static hdf5_file open(const std::string& path);
  ~hdf5_file();
  /// `other` has no file any more.
  hdf5_file(hdf5_file&& other) noexcept;
  hdf5_file& operator=(hdf5_file&&) = delete;

  /// Groups on the way of `name` ("fields/rho") are made as needed. Attributes "units" = "dimensionless" and,
  /// where given, "long_name".
  void write(const std::string& name, const std::vector<double>& values, const shape& extents,
             const std::string& long_name = "", precision stored = precision::float64);
  /// Text as a scalar dataset of UTF-8, without attributes.
  void write(const std::string& name, const std::string& text);
  /// A number among the attributes of the file.
  void write_attribute(const std::string& name, double value);
  /// Text among the attributes of the file.
  void write_attribute(const std::string& name, const std::string& value);
  /// Flushes to the disk; a full disk shows here and not in a destructor.
  void close();

  /// Whether there is a dataset or a group of this name.
  bool has(const std::string& name) const;
  /// The extents of a dataset; none for a single number.
  shape extents(const std::string& name) const;
  /// How the numbers of a dataset are stored.
  precision stored(const std::string& name) const;
  /// All numbers of a dataset, the last index running fastest. A dataset that is incomplete is refused.
  std::vector<double> read(const std::string& name) const;
  /// Text that write() wrote.
  std::string read_text(const std::string& name) const;
  /// A number among the attributes of the file.
  double read_attribute(const std::string& name) const;
  /// Names of all datasets, those in groups with their path ("fields/rho"), sorted.
  std::vector<std::string> datasets() const;
  /// Text among the attributes of the file.
  std::string read_text_attribute(const std::string& name) const;
  /// Numbers among the attributes of the file.
  std::vector<std::pair<std::string, double>> attributes() const;

 private:
  hdf5_file(std::string path, std::int64_t id);
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_to_write(const std::string& what) const;

  std::string path_;
  std::int64_t id_;
  std::unique_ptr<int> error_ = std::make_unique<int>(0);  ///< errno of the first write that failed
};

}  // namespace apsis
