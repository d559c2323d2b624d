// H5FD_CORE would keep every file in memory, and a full disk would end the process by SIGSEGV.
// posix_fallocate would need the size of a file beforehand (docs/measured.md).
#include <apsis/output/recording_driver.hpp>

#include <apsis/core/new_file.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <new>

#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#if H5_VERSION_GE(1, 14, 0)
#include <H5FDdevelop.h>
#endif

namespace apsis {
namespace {

/// Driver data of a property list.
struct access_info {
  int* error;
  bool only_numbers;  ///< writes only the numbers of an existing file
};

/// An open file; HDF5 accesses its first member.
struct recorded_file {
  H5FD_t base;
  int id;
  int* error;
  haddr_t allocated, end;
  dev_t device;
  ino_t inode;
  bool only_numbers;
};

recorded_file& of(H5FD_t* file) {
  return *reinterpret_cast<recorded_file*>(file);
}
const recorded_file& of(const H5FD_t* file) {
  return *reinterpret_cast<const recorded_file*>(file);
}

void record(recorded_file& file, int why) {
  if (*file.error == 0) *file.error = why != 0 ? why : EIO;
}

H5FD_t* open_file(const char* name, unsigned /*flags*/, hid_t access, haddr_t /*largest*/) {
  const auto* info = static_cast<const access_info*>(H5Pget_driver_info(access));
  if (info == nullptr) return nullptr;
  // Nothing is written through a link.
  const int id = info->only_numbers ? open(name, O_RDWR | O_CLOEXEC | O_NOFOLLOW) : create_new_file(name);
  struct stat status = {};
  if (id < 0 || fstat(id, &status) != 0) {
    *info->error = errno;
    if (id >= 0) close(id);
    return nullptr;
  }
  const auto end = info->only_numbers ? static_cast<haddr_t>(status.st_size) : 0;
  auto* file = new (std::nothrow)
      recorded_file{{}, id, info->error, 0, end, status.st_dev, status.st_ino, info->only_numbers};
  if (file == nullptr) {
    close(id);
    return nullptr;
  }
  return &file->base;
}

herr_t close_file(H5FD_t* file) {
  recorded_file& mine = of(file);
  // A network file system may report a full disk only now.
  if (mine.only_numbers && fsync(mine.id) != 0) record(mine, errno);
  if (close(mine.id) != 0) record(mine, errno);
  delete &mine;
  return 0;
}

int compare(const H5FD_t* a, const H5FD_t* b) {
  const recorded_file &x = of(a), &y = of(b);
  if (x.device != y.device) return x.device < y.device ? -1 : 1;
  if (x.inode != y.inode) return x.inode < y.inode ? -1 : 1;
  return 0;
}

/// Sets the features of HDF5's default driver, so that files have the same layout. A sieve would also write
/// numbers between those of this process, which belong to other processes.
herr_t query(const H5FD_t* file, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_AGGREGATE_SMALLDATA |
           H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  if (file == nullptr || !of(file).only_numbers) *flags |= H5FD_FEAT_DATA_SIEVE;
  return 0;
}

haddr_t allocated(const H5FD_t* file, H5FD_mem_t /*type*/) {
  return of(file).allocated;
}
herr_t allocate(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t address) {
  of(file).allocated = address;
  return 0;
}
haddr_t end_of(const H5FD_t* file, H5FD_mem_t /*type*/) {
  return of(file).end;
}

/// Reads zeros where the file has no data because they were discarded or never written.
herr_t read_bytes(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*list*/, haddr_t address, std::size_t size,
                  void* buffer) {
  auto* bytes = static_cast<char*>(buffer);
  while (size > 0) {
    const ssize_t got = pread(of(file).id, bytes, size, static_cast<off_t>(address));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    bytes += got;
    address += static_cast<haddr_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  std::memset(bytes, 0, size);
  return 0;
}

herr_t write_bytes(H5FD_t* file, H5FD_mem_t type, hid_t /*list*/, haddr_t address, std::size_t size,
                   const void* buffer) {
  recorded_file& mine = of(file);
  if (mine.only_numbers && type != H5FD_MEM_DRAW) return 0;
  const auto* bytes = static_cast<const char*>(buffer);
  mine.end = std::max(mine.end, address + size);
  while (size > 0 && *mine.error == 0) {
    const ssize_t put = pwrite(mine.id, bytes, size, static_cast<off_t>(address));
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) {
      record(mine, put < 0 ? errno : ENOSPC);
      break;
    }
    bytes += put;
    address += static_cast<haddr_t>(put);
    size -= static_cast<std::size_t>(put);
  }
  return 0;
}

herr_t truncate_file(H5FD_t* file, hid_t /*list*/, hbool_t /*closing*/) {
  recorded_file& mine = of(file);
  if (mine.end == mine.allocated || mine.only_numbers) return 0;
  if (*mine.error == 0 && ftruncate(mine.id, static_cast<off_t>(mine.allocated)) != 0) record(mine, errno);
  mine.end = mine.allocated;
  return 0;
}

hid_t driver() {
  static const hid_t registered = [] {
    H5FD_class_t made;
    std::memset(&made, 0, sizeof made);
#if H5_VERSION_GE(1, 14, 0)
    made.version = H5FD_CLASS_VERSION;
    made.value = static_cast<H5FD_class_value_t>(400);  // from the range reserved for unregistered drivers
#endif
    made.name = "apsis";
    made.maxaddr = (haddr_t{1} << 62) - 1;
    made.fc_degree = H5F_CLOSE_WEAK;
    made.fapl_size = sizeof(access_info);
    made.open = open_file;
    made.close = close_file;
    made.cmp = compare;
    made.query = query;
    made.get_eoa = allocated;
    made.set_eoa = allocate;
    made.get_eof = end_of;
    made.read = read_bytes;
    made.write = write_bytes;
    made.truncate = truncate_file;
    const H5FD_mem_t lists[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(lists), std::end(lists), std::begin(made.fl_map));
    return H5FDregister(&made);
  }();
  return registered;
}

}  // namespace

std::int64_t make_recording_access(int* error, bool only_numbers) {
  const hid_t list = H5Pcreate(H5P_FILE_ACCESS);
  const access_info info{error, only_numbers};
  if (list >= 0 && H5Pset_driver(list, driver(), &info) >= 0) return list;
  if (list >= 0) H5Pclose(list);
  return -1;
}

}  // namespace apsis
