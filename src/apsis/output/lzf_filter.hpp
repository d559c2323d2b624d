#pragma once

#include <cstddef>
#include <span>

namespace apsis {

/// Expands a block in the format of liblzf (Lehmann, https://oldhome.schmorp.de/marc/liblzf.html). A control
/// byte below 32 precedes that many literal bytes and one more; others hold the length, from 3, and the
/// distance of an earlier copy. Returns the number of bytes written; 0 if the block is damaged or does not
/// fit into `out`.
std::size_t expand_lzf(std::span<const unsigned char> in, std::span<unsigned char> out);

/// Makes HDF5 read datasets with the filter "lzf" of h5py (number 32000), which the library itself does not
/// have. A filter that is already available, as a plugin, is left.
void register_lzf_filter();

}  // namespace apsis
