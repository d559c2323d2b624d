#include <apsis/output/lzf_filter.hpp>

#include <algorithm>

#include <hdf5.h>

namespace apsis {

std::size_t expand_lzf(std::span<const unsigned char> in, std::span<unsigned char> out) {
  std::size_t at = 0, written = 0;
  const auto left = [&] { return in.size() - at; };
  while (left() > 0) {
    const std::size_t control = in[at++];
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > left() || length > out.size() - written) return 0;
      std::copy_n(in.begin() + static_cast<std::ptrdiff_t>(at), length,
                  out.begin() + static_cast<std::ptrdiff_t>(written));
      at += length;
      written += length;
      continue;
    }
    std::size_t length = control >> 5U;
    if (length == 7) {
      if (left() == 0) return 0;
      length += in[at++];
    }
    length += 2;
    if (left() == 0) return 0;
    const std::size_t distance = ((control & 31U) << 8U) + in[at++] + 1;
    if (distance > written || length > out.size() - written) return 0;
    // A copy may overlap itself, so it proceeds byte by byte.
    for (std::size_t k = 0; k < length; ++k, ++written) out[written] = out[written - distance];
  }
  return written;
}

namespace {

constexpr H5Z_filter_t number_of_lzf = 32000;

/// Expands a chunk for HDF5. The third value of the filter is the size of the expanded chunk in bytes.
std::size_t filter(unsigned flags, std::size_t count, const unsigned* values, std::size_t bytes,
                   std::size_t* size, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) == 0 || count < 3) return 0;  // this program reads such files only
  const std::size_t most = values[2];
  void* made = H5allocate_memory(std::max<std::size_t>(most, 1), false);
  if (made == nullptr) return 0;
  const std::size_t written = expand_lzf({static_cast<const unsigned char*>(*buffer), bytes},
                                         {static_cast<unsigned char*>(made), most});
  if (written == 0) {
    H5free_memory(made);
    return 0;
  }
  H5free_memory(*buffer);
  *buffer = made;
  *size = most;
  return written;
}

}  // namespace

void register_lzf_filter() {
  if (H5Zfilter_avail(number_of_lzf) > 0) return;
  const H5Z_class2_t lzf = {H5Z_CLASS_T_VERS, number_of_lzf, 0, 1, "lzf", nullptr, nullptr, filter};
  H5Zregister(&lzf);
}

}  // namespace apsis
