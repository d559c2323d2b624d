#pragma once

#include <apsis/mesh/field.hpp>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// Returns the field in memory of the host: the field itself, or a copy in `room` if it is in other memory.
inline const field& on_host(const field& u, field& room) {
  if (u.memory().on_host()) return u;
  if (room.cells() != u.cells() || room.components() != u.components() || !room.memory().on_host())
    room = field(u.cells(), u.components());
  room.copy_rows(u);
  return room;
}

/// Returns the row of a cell in memory of the host: the row itself, or a copy in `room`.
inline std::span<const double> row_on_host(const field& u, int cell, std::vector<double>& room) {
  const auto width = static_cast<std::size_t>(u.components());
  if (u.memory().on_host()) return {u.row(cell), width};
  room.resize(width);
  u.memory().copy_to_host(u.row(cell), width, room.data());
  return room;
}

/// Returns the field in `memory`: the field itself if it is there already, else a copy.
inline field moved_to(const memory_space& memory, field u) {
  if (&u.memory() == &memory) return u;
  field there(u.cells(), u.components(), memory);
  there.copy_rows(u);
  return there;
}

}  // namespace apsis
