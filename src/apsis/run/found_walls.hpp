#pragma once

#include <apsis/run/setup.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace apsis {

/// A side of the domain, a solid box or a body whose temperature follows from the gas, such
/// as an adiabatic wall.
struct found_wall {
  std::string name;  ///< as in run_setup::open_faces()
  std::size_t face;  ///< index in run_setup::open_faces()
  bool is_side;      ///< whether it is a side of the domain
};

/// Returns the walls whose temperature follows from the gas, in the order of run_setup::open_faces().
std::vector<found_wall> found_walls(const run_setup& setup);

/// Returns the history columns T_w_NAME, the mean temperatures of found_walls().
std::vector<std::string> temperature_columns(const run_setup& setup);

}  // namespace apsis
