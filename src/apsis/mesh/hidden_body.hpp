#pragma once

#include <apsis/core/errors.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/grid.hpp>

#include <cstddef>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace apsis {

/// The error for a body without a wall in the domain.
class hidden_body final : public input_error {
 public:
  /// `body` counts from 0, `reason` is that of why_hidden().
  hidden_body(std::size_t body, std::string reason)
      : input_error(message(fmt::format("body {}", body + 1), reason)),
        body_(body),
        reason_(std::move(reason)) {}

  std::size_t body() const { return body_; }             ///< number of the body, from 0
  const std::string& reason() const { return reason_; }  ///< reason and suggestion
  /// Returns the message for a body called `name`.
  static std::string message(const std::string& name, const std::string& reason) {
    return fmt::format("{} has no wall in the domain {}", name, reason);
  }

 private:
  std::size_t body_;
  std::string reason_;
};

/// Returns why a body has no wall in a mesh, and a suggestion: "(it lies outside the domain); move it, …".
/// For a body between the corners of cells the suggestion has the number of cells that show it. Its thickness
/// follows from the least value of φ, whose modulus must be about the distance from the surface.
std::string why_hidden(const grid& mesh, const outside_function& body);

}  // namespace apsis
