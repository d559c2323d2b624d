#pragma once

#include <apsis/core/errors.hpp>

#include <cstdint>
#include <exception>
#include <string>

namespace apsis {

/// An error as one process sends it to others; its message follows separately.
struct sent_error {
  /// The type of the exception.
  enum kind : int { other, memory, input, numerical, output, claim, interrupted, interrupted_early };
  int what = other;         ///< a kind
  std::int64_t length = 0;  ///< length of the message in bytes
  failure_site site;        ///< site of a numerical_error
};

/// Returns an error as it is sent, and stores its text in `message`.
sent_error describe(const std::exception_ptr& mine, std::string& message);

/// Throws an exception of the type, with the message and the site of the original.
[[noreturn]] void raise_error(const sent_error& sent, const std::string& message);

}  // namespace apsis
