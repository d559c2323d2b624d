#pragma once

#include <apsis/core/errors.hpp>

namespace apsis {

/// Returns body(), with a place added to its input errors.
template <class Body>
auto at_place(const source_place& place, const Body& body) {
  try {
    return body();
  } catch (const input_error& failure) {
    throw input_error(place, failure.what());
  }
}

}  // namespace apsis
