#pragma once

#include <apsis/run/setup.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace apsis {

/// A side of the domain, a solid box or a body with a temperature that follows from the gas, such as that of
/// an adiabatic wall.
struct found_wall {
  std::string name;  ///< run_setup::open_faces()
  std::size_t face;  ///< its place among these
  bool is_side;      ///< whether it is a side of the domain
};

/// Returns these walls in the order of run_setup::open_faces().
std::vector<found_wall> found_walls(const run_setup& setup);

/// Returns the columns of their mean temperatures in the history, T_w_NAME.
std::vector<std::string> temperature_columns(const run_setup& setup);

}  // namespace apsis
