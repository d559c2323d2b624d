#pragma once

#include <apsis/mesh/cut_cells.hpp>

#include <array>
#include <vector>

namespace apsis {

/// A neighbour in the gradient g = Σ weight (f_cell − f) of a group of cut cells.
struct gradient_weight {
  int cell;                      ///< a whole cell, or the first cell of a group
  std::array<double, 3> weight;  ///< weight for each direction
};

/// Returns the neighbours behind the open faces of a group with the weights of a least-squares
/// gradient (weights 1/distance²). The gradient has no component along directions in which the
/// neighbours hardly differ.
std::vector<gradient_weight> gradient_weights(const cut_cells& cut, int group);

}  // namespace apsis
