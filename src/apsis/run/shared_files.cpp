#include <apsis/run/shared_files.hpp>

#include <apsis/core/first_error.hpp>
#include <apsis/exec/agreement.hpp>

#include <cstdint>
#include <span>

namespace apsis {

void broadcast_text(communicator& processes, std::string& text) {
  auto length = static_cast<std::int64_t>(text.size());
  processes.broadcast(std::as_writable_bytes(std::span(&length, 1)));
  text.resize(static_cast<std::size_t>(length));
  processes.broadcast(std::as_writable_bytes(std::span(text.data(), text.size())));
}

void write_by_all(communicator& processes, const std::function<void(const file_writer&)>& prepare,
                  const file_writer& write) {
  if (processes.is_single()) return prepare(write);
  first_error failure;
  std::string path;
  if (processes.is_root()) {
    bool asked = false;
    failure.run([&] {
      prepare([&](const std::string& given) {
        asked = true;
        path = given;
        broadcast_text(processes, path);
        write(path);
      });
    });
    // prepare() gave no path: releases the others, which wait for one.
    if (!asked) broadcast_text(processes, path);
  } else {
    broadcast_text(processes, path);
    if (!path.empty()) failure.run([&] { write(path); });
  }
  agree_on_errors(processes, failure.take());
}

}  // namespace apsis
