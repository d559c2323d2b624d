#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/mesh/phase_space.hpp>
#include <apsis/steady/cell_links.hpp>

#include <array>
#include <vector>

namespace apsis {

/// The boundary condition at an end of a segment as a map of rows, for any kind of boundary. It returns the
/// components that enter for a constant state in front of the end. An object has scratch memory and serves
/// a single thread.
class end_response {
 public:
  /// `space` must outlive the object.
  explicit end_response(const phase_space& space, int stride);

  /// row[k] ← the value from the boundary for components that enter, if all rows in front of it equal
  /// `inside`. Other components are inside[k]. At the axis it is the value that continues F = r f to r < 0.
  /// Throws what the boundary throws.
  void values_at(const gas_end_of_segment& end, const double* inside, double* row);

 private:
  static constexpr std::size_t most_ghosts = 2;

  const velocity_set& velocities_;
  std::array<aligned_vector<double>, most_ghosts> ghosts_;
  aligned_vector<double> outgoing_, incoming_;
};

}  // namespace apsis
