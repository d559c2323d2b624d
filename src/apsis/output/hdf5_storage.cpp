#include <apsis/output/hdf5_storage.hpp>

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>
#include <hdf5.h>

namespace apsis {
namespace {

/// The creation properties of a dataset.
class properties {
 public:
  explicit properties(hid_t data) : id_(H5Dget_create_plist(data)) {}
  ~properties() {
    if (id_ >= 0) H5Pclose(id_);
  }
  properties(const properties&) = delete;
  properties& operator=(const properties&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
};

/// The extents of a dataset.
class dataspace {
 public:
  explicit dataspace(hid_t data) : id_(H5Dget_space(data)) {}
  ~dataspace() {
    if (id_ >= 0) H5Sclose(id_);
  }
  dataspace(const dataspace&) = delete;
  dataspace& operator=(const dataspace&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
};

/// Returns the name of a filter that the library lacks; "" if it has all.
std::string missing_filter(const properties& of) {
  const int count = H5Pget_nfilters(of);
  for (int k = 0; k < count; ++k) {
    std::array<char, 64> name{};
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(of, static_cast<unsigned>(k), &flags, &values, nullptr,
                                               name.size() - 1, name.data(), nullptr);
    if (filter >= 0 && H5Zfilter_avail(filter) <= 0) return fmt::format("{} ({})", name.data(), filter);
  }
  return {};
}

/// Returns whether every number of a dataset was written. Counts chunks, because the size of compressed
/// ones does not show it.
bool is_complete(hid_t data, const properties& of) {
  const dataspace space(data);
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> extents(static_cast<std::size_t>(std::max(rank, 0))), chunk(extents.size());
  H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  if (std::find(extents.begin(), extents.end(), hsize_t{0}) != extents.end()) return true;
  if (H5Pget_layout(of) != H5D_CHUNKED) {
    H5D_space_status_t status = H5D_SPACE_STATUS_ERROR;
    return H5Dget_space_status(data, &status) >= 0 && status == H5D_SPACE_STATUS_ALLOCATED;
  }
  hsize_t written = 0, needed = 1;
  if (H5Pget_chunk(of, rank, chunk.data()) < 0 || H5Dget_num_chunks(data, space, &written) < 0) return false;
  for (std::size_t k = 0; k < chunk.size(); ++k) needed *= (extents[k] + chunk[k] - 1) / chunk[k];
  return written >= needed;
}

}  // namespace

bool holds_real_numbers(std::int64_t data) {
  const hid_t type = H5Dget_type(data);
  const H5T_class_t kind = H5Tget_class(type);
  H5Tclose(type);
  return H5Sget_simple_extent_type(dataspace(data)) != H5S_NULL && (kind == H5T_INTEGER || kind == H5T_FLOAT);
}

std::string problem_of_storage(std::int64_t data) {
  if (!holds_real_numbers(data)) return "has no real numbers (another type is stored); give real numbers";
  const properties of(data);
  if (H5Pget_layout(of) == H5D_VIRTUAL || H5Pget_external_count(of) > 0)
    return "refers to numbers in other files (a virtual or external dataset); store its numbers in this file";
  if (const std::string filter = missing_filter(of); !filter.empty())
    return fmt::format(
        "is compressed by the filter {} (this HDF5 library does not have it); store it with gzip", filter);
  H5D_fill_value_t fill = H5D_FILL_VALUE_ERROR;
  if (H5Pfill_value_defined(of, &fill) < 0) return "cannot be read (damaged file); give another file";
  if (fill != H5D_FILL_VALUE_USER_DEFINED && !is_complete(data, of))
    return "is incomplete (some of its numbers were never written); give another file";
  return {};
}

}  // namespace apsis
