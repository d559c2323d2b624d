#pragma once

#include <apsis/exec/communicator.hpp>

#include <functional>
#include <string>

namespace apsis {

/// Writes a file to a path.
using file_writer = std::function<void(const std::string& path)>;

/// Writes a file by all processes. The root calls prepare(w), which must call w(path) with the path of the
/// file; write(path) then runs on all processes. If one process throws, all throw. Collective.
void write_by_all(communicator& processes, const std::function<void(const file_writer&)>& prepare,
                  const file_writer& write);

/// Replaces the text by that of the root. Collective.
void broadcast_text(communicator& processes, std::string& text);

}  // namespace apsis
