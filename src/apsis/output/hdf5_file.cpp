#include <apsis/output/hdf5_file.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/new_file.hpp>
#include <apsis/exec/agreement.hpp>
#include <apsis/exec/memory.hpp>
#include <apsis/output/hdf5_storage.hpp>
#include <apsis/output/lzf_filter.hpp>
#include <apsis/output/provenance.hpp>
#include <apsis/output/recording_driver.hpp>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <numeric>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

namespace apsis {
namespace {

// Larger than any result of this program, so that a damaged file does not exhaust memory.
constexpr std::uint64_t most_elements = std::uint64_t{1} << 33U;
constexpr std::size_t longest_text = 10'000'000;

class handle {
 public:
  using closer = herr_t (*)(hid_t);
  handle(hid_t id, closer close) : id_(id), close_(close) {}
  ~handle() {
    if (id_ >= 0) close_(id_);
  }
  handle(const handle&) = delete;
  handle& operator=(const handle&) = delete;
  operator hid_t() const { return id_; }
  bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  closer close_;
};

void silence() {
  static const herr_t once = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  static_cast<void>(once);
}

/// Returns the lock for all HDF5 files of this process.
std::recursive_mutex& access_to_hdf5() {
  static std::recursive_mutex of_all;
  return of_all;
}

handle text_type(std::size_t length) {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_cset(type, H5T_CSET_UTF8);
  return {type, H5Tclose};
}

bool write_text_attribute(hid_t object, const std::string& name, const std::string& value) {
  const handle type = text_type(value.size());
  const handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.good() && H5Awrite(attribute, type, value.c_str()) >= 0;
}

// Returns the properties of a new object without time stamps. Numbers have their place in the file from the
// beginning, so that other processes can write them.
handle creation_properties(hid_t what) {
  const hid_t list = H5Pcreate(what);
  H5Pset_obj_track_times(list, false);
  if (what == H5P_DATASET_CREATE) {
    H5Pset_alloc_time(list, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(list, H5D_FILL_TIME_NEVER);
  }
  return {list, H5Pclose};
}

/// Selects a part of a dataset, or nothing if the part has no numbers.
bool select(hid_t space, const dataset_part& part) {
  if (std::find(part.count.begin(), part.count.end(), 0U) != part.count.end())
    return H5Sselect_none(space) >= 0;
  const std::vector<hsize_t> first(part.first.begin(), part.first.end()),
      count(part.count.begin(), part.count.end());
  return H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr) >= 0;
}

hsize_t size_of(const dataset_part& part) {
  return std::accumulate(part.count.begin(), part.count.end(), hsize_t{1}, std::multiplies<>());
}

bool write_selected(hid_t data, hid_t space, const dataset_part& part, const double* values) {
  const hsize_t numbers = size_of(part);
  const handle memory(H5Screate_simple(1, &numbers, nullptr), H5Sclose);
  if (numbers == 0) H5Sselect_none(memory);
  return select(space, part) && H5Dwrite(data, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values) >= 0;
}

/// Returns the text of an attribute, of fixed length or, from other programs, of variable length.
std::optional<std::string> text_of_attribute(hid_t attribute) {
  const handle type(H5Aget_type(attribute), H5Tclose);
  const handle space(H5Aget_space(attribute), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1 ||
      H5Tget_size(type) > longest_text)
    return std::nullopt;
  if (H5Tis_variable_str(type) <= 0) {
    std::string text(H5Tget_size(type), '\0');
    if (H5Aread(attribute, type, text.data()) < 0) return std::nullopt;
    return text.substr(0, text.find('\0'));
  }
  char* found = nullptr;
  if (H5Aread(attribute, type, static_cast<void*>(&found)) < 0 || found == nullptr) return std::nullopt;
  std::string text = found;
  H5free_memory(found);
  return text;
}

/// Creates the parent groups of "a/b/name".
bool make_groups(hid_t file, const std::string& name) {
  const handle properties = creation_properties(H5P_GROUP_CREATE);
  for (auto slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1)) {
    const std::string group = name.substr(0, slash);
    if (H5Lexists(file, group.c_str(), H5P_DEFAULT) > 0) continue;
    if (!handle(H5Gcreate2(file, group.c_str(), H5P_DEFAULT, properties, H5P_DEFAULT), H5Gclose).good())
      return false;
  }
  return true;
}

}  // namespace

hdf5_file::hdf5_file(std::string path, content written)
    : access_(access_to_hdf5()), path_(std::move(path)), content_(written) {
  silence();
}

hdf5_file::hdf5_file(hdf5_file&& other) noexcept
    : access_(std::move(other.access_)),
      path_(std::move(other.path_)),
      id_(std::exchange(other.id_, -1)),
      error_(std::move(other.error_)),
      content_(other.content_),
      process_(std::move(other.process_)) {}

hdf5_file::~hdf5_file() {
  if (id_ >= 0) H5Fclose(id_);
}

void hdf5_file::fail(const std::string& what) const {
  throw io_error(fmt::format("'{}': {}", path_, what));
}

void hdf5_file::fail_to_write(const std::string& what) const {
  fail(fmt::format("{} ({}{}{}); free some space or choose another folder", what, process_,
                   process_.empty() ? "" : ": ",
                   *error_ != 0 ? why_not_written(path_, *error_) : "no reason given by HDF5"));
}

hdf5_file hdf5_file::create(const std::string& path, std::uint64_t free_bytes) {
  return create(path, free_bytes, content::all);
}

hdf5_file hdf5_file::create_frame(const std::string& path, std::uint64_t free_bytes) {
  return create(path, free_bytes, content::frame);
}

hdf5_file hdf5_file::create(const std::string& path, std::uint64_t free_bytes, content written) {
  hdf5_file file(path, written);
  const handle creation = creation_properties(H5P_FILE_CREATE);
  H5Pset_userblock(creation, free_bytes);
  const handle access(make_recording_access(file.error_.get()), H5Pclose);
  // Version 1.8 and later can have attributes of more than 64 KiB, such as a long case.
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  file.id_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access);
  if (file.id_ < 0) file.fail_to_write("cannot be created");
  return file;
}

hdf5_file hdf5_file::open_parts(const std::string& path, const std::string& process) {
  hdf5_file file(path, content::parts);
  file.process_ = process;
  const handle access(make_recording_access(file.error_.get(), true), H5Pclose);
  file.id_ = H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
  if (file.id_ < 0) file.fail_to_write("cannot be opened for writing");
  return file;
}

hdf5_file hdf5_file::open(const std::string& path) {
  hdf5_file file(path);
  register_lzf_filter();
  file.id_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file.id_ < 0)
    file.fail("cannot be opened (missing, damaged, or not an HDF5 file); give a file written by apsis");
  return file;
}

void hdf5_file::close() {
  const hid_t id = std::exchange(id_, -1);
  const bool flushed = H5Fflush(id, H5F_SCOPE_GLOBAL) >= 0;
  if (H5Fclose(id) < 0 || !flushed || *error_ != 0) fail_to_write("cannot be written completely");
}

void hdf5_file::write(const std::string& name, const std::vector<double>& values, const shape& extents,
                      const std::string& long_name, precision stored, const std::string& units) {
  write_numbers(name, values.data(), extents, nullptr, long_name, stored, units);
}

void hdf5_file::write_part(const std::string& name, const std::vector<double>& values, const shape& extents,
                           const dataset_part& part, const std::string& long_name, precision stored,
                           const std::string& units) {
  write_numbers(name, values.data(), extents, &part, long_name, stored, units);
}

void hdf5_file::write_numbers(const std::string& name, const double* values, const shape& extents,
                              const dataset_part* part, const std::string& long_name, precision stored,
                              const std::string& units) {
  if (!writes_frame()) return write_reserved(name, values, part);
  const std::vector<hsize_t> dims(extents.begin(), extents.end());
  const handle space(H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose);
  const handle properties = creation_properties(H5P_DATASET_CREATE);
  const bool with_groups = make_groups(id_, name);
  const hid_t type = stored == precision::float64 ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
  const handle data(H5Dcreate2(id_, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                    H5Dclose);
  bool written = with_groups && data.good();
  if (part == nullptr)
    written = H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0 && written;
  else if (content_ == content::all)
    written = write_selected(data, space, *part, values) && written;
  written = write_text_attribute(data, "units", units) && written;
  written = (long_name.empty() || write_text_attribute(data, "long_name", long_name)) && written;
  if (!written || *error_ != 0) fail_to_write(fmt::format("'{}' cannot be written", name));
}

void hdf5_file::write_reserved(const std::string& name, const double* values, const dataset_part* part) {
  if (part == nullptr) return;
  const handle data(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose);
  const handle space(H5Dget_space(data), H5Sclose);
  if (!data.good() || !write_selected(data, space, *part, values) || *error_ != 0)
    fail_to_write(fmt::format("'{}' cannot be written", name));
}

void hdf5_file::write(const std::string& name, const std::string& text) {
  if (!writes_frame()) return;
  const bool with_groups = make_groups(id_, name);
  const handle type = text_type(text.size());
  const handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const handle properties = creation_properties(H5P_DATASET_CREATE);
  const handle data(H5Dcreate2(id_, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                    H5Dclose);
  if (!with_groups || !data.good() || H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) < 0 ||
      *error_ != 0)
    fail_to_write(fmt::format("'{}' cannot be written", name));
}

void hdf5_file::write_attribute(const std::string& name, double value) {
  if (!writes_frame()) return;
  const handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const handle attribute(H5Acreate2(id_, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.good() || H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) < 0)
    fail_to_write(fmt::format("attribute '{}' cannot be written", name));
}

void hdf5_file::write_attribute(const std::string& name, const std::string& value) {
  if (writes_frame() && !write_text_attribute(id_, name, value))
    fail_to_write(fmt::format("attribute '{}' cannot be written", name));
}

std::string hdf5_version() {
  const std::lock_guard lock(access_to_hdf5());
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

void write_hdf5(const std::string& path, std::uint64_t free_bytes,
                const std::shared_ptr<communicator>& processes,
                const std::function<void(hdf5_file&)>& contents) {
  const auto write = [&](hdf5_file file) {
    contents(file);
    file.close();
  };
  if (!processes || processes->is_single()) return write(hdf5_file::create(path, free_bytes));
  run_collectively(*processes, [&] {
    if (processes->is_root()) write(hdf5_file::create_frame(path, free_bytes));
  });
  run_collectively(*processes, [&] {
    write(hdf5_file::open_parts(path, fmt::format("process {} on {}", processes->rank(), host_name())));
  });
}

bool hdf5_file::has(const std::string& name) const {
  return H5Lexists(id_, name.c_str(), H5P_DEFAULT) > 0 &&
         H5Oexists_by_name(id_, name.c_str(), H5P_DEFAULT) > 0;
}

bool hdf5_file::has_attribute(const std::string& name) const {
  return H5Aexists(id_, name.c_str()) > 0;
}

hdf5_file::shape hdf5_file::extents(const std::string& name) const {
  const handle data(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.good())
    fail(fmt::format("has no dataset '{}' (not written by this program?); give another file", name));
  const handle space(H5Dget_space(data), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  std::vector<hsize_t> dims(rank > 0 ? static_cast<std::size_t>(rank) : 0);
  if (rank < 0 || H5Sget_simple_extent_dims(space, dims.data(), nullptr) < 0)
    fail(fmt::format("the extents of '{}' cannot be read (damaged file); give another file", name));
  return {dims.begin(), dims.end()};
}

precision hdf5_file::stored(const std::string& name) const {
  const handle data(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.good())
    fail(fmt::format("has no dataset '{}' (not written by this program?); give another file", name));
  const handle type(H5Dget_type(data), H5Tclose);
  return H5Tget_size(type) == sizeof(float) ? precision::float32 : precision::float64;
}

std::string hdf5_file::units(const std::string& name) const {
  const handle data(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.good() || H5Aexists(data, "units") <= 0) return "";
  const handle attribute(H5Aopen(data, "units", H5P_DEFAULT), H5Aclose);
  const auto text = text_of_attribute(attribute);
  if (!text) fail(fmt::format("the attribute 'units' of '{}' is not text; remove it", name));
  return *text;
}

/// Throws unless the numbers of a dataset can be read, and `count` of them fit into memory.
void hdf5_file::check_numbers(const std::string& name, std::int64_t data, std::uint64_t count) const {
  if (const std::string problem = problem_of_storage(data); !problem.empty())
    fail(fmt::format("'{}' {}", name, problem));
  constexpr double gibibyte = 1024.0 * 1024.0 * 1024.0;
  const double needed = static_cast<double>(count) * sizeof(double);
  if (needed < gibibyte) return;
  if (const memory_limit there = available_memory(); needed > there.bytes)
    fail(fmt::format("'{}' claims {:.3g} GiB of numbers (the {} has {:.3g} GiB left); give a smaller table",
                     name, needed / gibibyte, there.source, there.bytes / gibibyte));
}

std::vector<double> hdf5_file::read(const std::string& name) const {
  std::uint64_t count = 1;
  for (const std::uint64_t n : extents(name)) {
    if (n > most_elements || (n > 0 && count > most_elements / n))
      fail(fmt::format("'{}' claims an impossible size (damaged file); give another file", name));
    count *= n;
  }
  const handle data(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose);
  check_numbers(name, data, count);
  std::vector<double> values(count);
  if (H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail(fmt::format("'{}' cannot be read (damaged file); give another file", name));
  return values;
}

std::vector<double> hdf5_file::read_part(const std::string& name, const dataset_part& part) const {
  const auto all = extents(name);
  for (std::size_t k = 0; k < part.first.size(); ++k)
    if (all.size() != part.first.size() || part.first[k] + part.count[k] > all[k])
      fail(fmt::format("'{}' has another shape (damaged file); give another file", name));
  const handle data(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose);
  const handle space(H5Dget_space(data), H5Sclose);
  const hsize_t numbers = size_of(part);
  check_numbers(name, data, numbers);
  std::vector<double> values(numbers);
  const handle memory(H5Screate_simple(1, &numbers, nullptr), H5Sclose);
  if (numbers > 0 && (!select(space, part) ||
                      H5Dread(data, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, values.data()) < 0))
    fail(fmt::format("'{}' cannot be read (damaged file); give another file", name));
  return values;
}

std::string hdf5_file::read_text(const std::string& name) const {
  const handle data(H5Dopen2(id_, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!data.good())
    fail(fmt::format("has no text '{}' (not written by this program?); give another file", name));
  const handle type(H5Dget_type(data), H5Tclose);
  const handle space(H5Dget_space(data), H5Sclose);
  const std::size_t length = H5Tget_size(type);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || length > longest_text ||
      H5Sget_simple_extent_npoints(space) != 1)
    fail(fmt::format("'{}' is not text (damaged file); give another file", name));
  std::string text(length, '\0');
  if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
    fail(fmt::format("'{}' cannot be read (damaged file); give another file", name));
  return text;
}

double hdf5_file::read_attribute(const std::string& name) const {
  for (const auto& [key, value] : attributes())
    if (key == name) return value;
  fail(fmt::format("has no number '{}' (not written by this program?); give another file", name));
}

namespace {

/// Calls see(name, type of the link) for every link of a group, in alphabetical order.
template <class See>
void for_links(hid_t group, const See& see) {
  H5G_info_t info;
  if (H5Gget_info(group, &info) < 0) return;
  for (hsize_t k = 0; k < info.nlinks; ++k) {
    H5L_info_t link;
    const auto length =
        H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, nullptr, 0, H5P_DEFAULT);
    if (length < 0 || static_cast<std::size_t>(length) > longest_text ||
        H5Lget_info_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, &link, H5P_DEFAULT) < 0)
      continue;
    std::string name(static_cast<std::size_t>(length), '\0');
    H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, k, name.data(), name.size() + 1, H5P_DEFAULT);
    see(name, link.type);
  }
}

#if H5_VERSION_GE(1, 12, 0)
using object_info = H5O_info1_t;
#else
using object_info = H5O_info_t;
#endif

/// Adds the datasets of a group and its subgroups, each group once: links may form circles.
void list_datasets(hid_t group, const std::string& prefix, std::set<haddr_t>& seen,
                   std::vector<std::string>& names) {
  for_links(group, [&](const std::string& name, H5L_type_t link) {
    const handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
    const auto type = object.good() ? H5Iget_type(object) : H5I_BADID;
    if (type == H5I_DATASET) names.push_back(prefix + name);
    object_info info;
    if (type == H5I_GROUP && link == H5L_TYPE_HARD && H5Oget_info1(object, &info) >= 0 &&
        seen.insert(info.addr).second)
      list_datasets(object, prefix + name + "/", seen, names);
  });
}

}  // namespace

std::vector<std::string> hdf5_file::datasets() const {
  std::vector<std::string> names;
  const handle root(H5Gopen2(id_, "/", H5P_DEFAULT), H5Gclose);
  std::set<haddr_t> seen;
  if (object_info info; root.good() && H5Oget_info1(root, &info) >= 0) seen.insert(info.addr);
  if (seen.empty()) fail("its contents cannot be listed (damaged file); give another file");
  list_datasets(root, "", seen, names);
  return names;
}

std::vector<std::string> hdf5_file::number_sets(const std::string& group) const {
  std::vector<std::string> names;
  const handle from(H5Gopen2(id_, group.empty() ? "/" : group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!from.good()) return names;
  for_links(from, [&](const std::string& name, H5L_type_t) {
    const handle object(H5Oopen(from, name.c_str(), H5P_DEFAULT), H5Oclose);
    if (object.good() && H5Iget_type(object) == H5I_DATASET && holds_real_numbers(object))
      names.push_back(name);
  });
  return names;
}

std::string hdf5_file::read_text_attribute(const std::string& name) const {
  const handle attribute(H5Aopen(id_, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.good())
    fail(fmt::format("has no text '{}' (not written by this program?); give another file", name));
  const auto text = text_of_attribute(attribute);
  if (!text) fail(fmt::format("'{}' is not text (damaged file); give another file", name));
  return *text;
}

std::vector<std::pair<std::string, double>> hdf5_file::attributes() const {
  std::vector<std::pair<std::string, double>> all;
  for (hsize_t k = 0;; ++k) {
    const handle attribute(H5Aopen_by_idx(id_, ".", H5_INDEX_NAME, H5_ITER_INC, k, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    // Opening fails past the last attribute in every version of the library.
    if (!attribute.good()) return all;
    const handle type(H5Aget_type(attribute), H5Tclose);
    const handle space(H5Aget_space(attribute), H5Sclose);
    if (H5Tget_class(type) != H5T_FLOAT || H5Sget_simple_extent_npoints(space) != 1) continue;
    std::vector<char> name(256);
    double value = 0.0;
    if (H5Aget_name(attribute, name.size(), name.data()) < 0 ||
        H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0)
      fail("its attributes cannot be read (damaged file); give another file");
    all.emplace_back(name.data(), value);
  }
}

}  // namespace apsis
