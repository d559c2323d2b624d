#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/mesh/phase_space.hpp>
#include <apsis/steady/cell_links.hpp>

#include <array>
#include <vector>

namespace apsis {

/// The boundary condition at an end of a segment as a map of rows, of any kind of boundary: the components
/// that enter for a constant state in front of it. Has scratch memory: one object per thread.
class end_response {
 public:
  /// `space` must outlive the object.
  explicit end_response(const phase_space& space, int stride);

  /// row[k] of the components that enter ← what the boundary emits if all components in front of it are those
  /// of `inside`; other components are inside[k]. Throws what the boundary throws.
  void values_at(const gas_end_of_segment& end, const double* inside, double* row);

 private:
  static constexpr std::size_t most_ghosts = 2;

  const velocity_set& velocities_;
  std::array<aligned_vector<double>, most_ghosts> ghosts_;
  aligned_vector<double> outgoing_, incoming_;
};

}  // namespace apsis
