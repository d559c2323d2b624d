#include "method_writer.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/method/export.hpp>

#include <fstream>

#include <fmt/format.h>

namespace apsis::app {

method_writer::method_writer(const std::string& path)
    : path_(path), folder_(path_.has_parent_path() ? path_.parent_path() : std::filesystem::path(".")) {
  if (!path_.has_filename() || path_.extension() != ".toml")
    throw input_error(
        fmt::format("command line: --out '{}' is not a method file (its name does not end in .toml); write "
                    "for example my-method.toml",
                    path));
}

void method_writer::write(const method& m) {
  folder_.publish(path_.filename().string(), [&m](const std::string& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << to_toml(m);
    out.close();
    if (!out) throw io_error(fmt::format("cannot write '{}' (no space left); free some space", temporary));
  });
}

}  // namespace apsis::app
