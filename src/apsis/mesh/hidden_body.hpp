#pragma once

#include <apsis/core/errors.hpp>

#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace apsis {

/// The error for a body without a wall in the domain.
class hidden_body final : public input_error {
 public:
  /// `body` counts from 0.
  explicit hidden_body(std::size_t body)
      : input_error(message(fmt::format("body {}", body + 1))), body_(body) {}

  std::size_t body() const { return body_; }  ///< number of the body, from 0
  /// Returns the message for a body called `name`.
  static std::string message(const std::string& name) {
    return name +
           " has no wall in the domain (it lies outside, in another body, or between the corners of cells); "
           "move it, or increase space.cells";
  }

 private:
  std::size_t body_;
};

}  // namespace apsis
