#include "print.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/printable.hpp>

#include <cstdio>

namespace apsis::app {

void print(const std::string& given) {
  const std::string text = printable(given);
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0)
    throw io_error("standard output cannot be written (closed or full); check where it goes");
}

}  // namespace apsis::app
