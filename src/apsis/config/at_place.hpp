#pragma once

#include <apsis/boundary/face_value_error.hpp>
#include <apsis/core/errors.hpp>

namespace apsis {

/// Returns body(). Adds a place to those of its input errors that have none.
template <class Body>
auto at_place(const source_place& place, const Body& body) {
  try {
    return body();
  } catch (const face_value_error&) {
    throw;
  } catch (const input_error& failure) {
    throw input_error(place, failure.what());
  }
}

}  // namespace apsis
