#include <apsis/core/errors.hpp>
#include <apsis/core/printable.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

#include <cstddef>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis {

void reconstruction::outflow_edges(const double* const* rows, int count, int width, const double* forward,
                                   double* edge) const {
  // Each thread has one pair of buffers, so that memory is allocated only until they have grown.
  thread_local aligned_vector<double> left, right;
  const std::size_t size = static_cast<std::size_t>(count) * static_cast<std::size_t>(width);
  left.resize(size);
  right.resize(size);
  edges(rows, count, width, left.data(), right.data());
  for (std::size_t n = 0; n < size; ++n)
    edge[n] = forward[n % static_cast<std::size_t>(width)] > 0.0 ? right[n] : left[n];
}

double reconstruction::operations(bool) const {
  return 0.0;
}

const reconstruction_entry* try_find_reconstruction(const std::string& name) {
  for (const reconstruction_entry* entry : reconstruction_entries())
    if (entry->name == name) return entry;
  return nullptr;
}

const reconstruction_entry& find_reconstruction(const std::string& name) {
  if (const reconstruction_entry* found = try_find_reconstruction(name)) return *found;
  std::vector<std::string> names;
  for (const reconstruction_entry* entry : reconstruction_entries()) names.push_back(entry->name);
  throw input_error(fmt::format("unknown reconstruction '{}' (there is no such name); {}", printable(name),
                                suggest(name, names)));
}

}  // namespace apsis
