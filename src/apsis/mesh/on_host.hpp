#pragma once

#include <apsis/mesh/field.hpp>

#include <utility>

namespace apsis {

/// Returns the field where the host can read it: the field itself, or a copy in `room` of one in other
/// memory.
inline const field& on_host(const field& u, field& room) {
  if (u.memory().on_host()) return u;
  if (room.cells() != u.cells() || room.components() != u.components() || !room.memory().on_host())
    room = field(u.cells(), u.components());
  room.copy_rows(u);
  return room;
}

/// Returns the field in other memory: itself where it lives there already.
inline field moved_to(const memory_space& memory, field u) {
  if (&u.memory() == &memory) return u;
  field there(u.cells(), u.components(), memory);
  there.copy_rows(u);
  return there;
}

}  // namespace apsis
