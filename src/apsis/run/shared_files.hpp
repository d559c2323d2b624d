#pragma once

#include <apsis/exec/communicator.hpp>

#include <functional>
#include <string>

namespace apsis {

/// Writes the file of a path.
using file_writer = std::function<void(const std::string& path)>;

/// Writes a file by all processes: the root calls prepare(w) with a function that it must call with the path
/// of the file, and write(path) runs on all of them. Throws on all what one of them throws. Collective.
void write_by_all(communicator& processes, const std::function<void(const file_writer&)>& prepare,
                  const file_writer& write);

/// text ← that of the root.
void broadcast_text(communicator& processes, std::string& text);

}  // namespace apsis
