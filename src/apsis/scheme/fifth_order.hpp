#pragma once

#include <apsis/scheme/reconstruction.hpp>

#include <memory>

namespace apsis {

/// Loops of a reconstruction over a pencil; see the members of `reconstruction` of the same names.
struct pencil_loops {
  void (*edges)(const double* const* rows, int count, int width, double* left, double* right);
  void (*outflow_edges)(const double* const* rows, int count, int width, const double* forward, double* edge);
  double (*operations)(bool both_edges);
};

/// Makes a scheme of fifth order, which needs the two neighbours on either side.
std::unique_ptr<reconstruction> make_fifth_order(const pencil_loops& loops);

}  // namespace apsis
