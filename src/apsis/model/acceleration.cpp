#include <apsis/model/acceleration.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/model/model.hpp>

#include <cstddef>

#include <fmt/format.h>

namespace apsis {

void check_velocities(const acceleration& of, const velocity_lattice& lattice) {
  constexpr int least = 5;  // points on which an edge depends
  for (std::size_t k = 0; k < lattice.points.size(); ++k) {
    if (!(of.largest[k] > 0.0)) continue;
    if (lattice.spacing[k] == 0.0)
      throw input_error(fmt::format(
          "velocity.set has unequal distances along velocity direction {} (a force acts along it); write "
          "\"uniform\" for this direction",
          k + 1));
    if (lattice.points[k] < least)
      throw input_error(fmt::format(
          "velocity.points = {} is too few along velocity direction {} (a force acts along it); give at "
          "least {}",
          lattice.points[k], k + 1, least));
  }
}

}  // namespace apsis
