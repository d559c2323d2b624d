#pragma once

#include <cstddef>
#include <span>

namespace apsis {

/// Expands a block in the format of liblzf (Lehmann, https://oldhome.schmorp.de/marc/liblzf.html). A control
/// byte c < 32 precedes c + 1 literal bytes. Other control bytes begin a copy of earlier bytes, with its
/// length, from 3, and its distance. Returns the number of bytes written; 0 if the block is damaged or does
/// not fit into `out`.
std::size_t expand_lzf(std::span<const unsigned char> in, std::span<unsigned char> out);

/// Makes HDF5 read datasets with the filter "lzf" of h5py (number 32000), which the library itself does not
/// have. Keeps a filter that is already available as a plugin.
void register_lzf_filter();

}  // namespace apsis
