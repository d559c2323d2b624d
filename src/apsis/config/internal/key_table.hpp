#pragma once

#include <apsis/config/internal/key_of_member.hpp>

#include <string>
#include <vector>

namespace apsis {

/// A table of keys of a case: a file of config/keys/ defines `extern const key_table_entry
/// key_table_<file>`.
struct key_table_entry {
  int place = 1000;                           ///< position in a written case, lowest first
  std::vector<case_key> (*keys)() = nullptr;  ///< returns the keys in the order of reading
};

/// Returns all tables of keys, sorted by file name (generated).
std::vector<const key_table_entry*> key_table_entries();

/// Returns the names of the entries of a registry, as the choices of a key.
template <class Entries>
auto names_in(Entries (*entries)()) {
  return [entries](const case_config&) {
    std::vector<std::string> names;
    for (const auto* entry : entries()) names.push_back(entry->name);
    return names;
  };
}

/// Returns the key. Its value counts as not given if it is 0 or empty.
case_key if_given(case_key of);

/// Returns the key for those cases that have a property.
case_key only_if(bool (*property)(const case_config&), case_key of);

}  // namespace apsis
