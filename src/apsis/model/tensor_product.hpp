#pragma once

#include <apsis/model/maxwellian.hpp>

#include <array>

namespace apsis {

/// m ← factor Π_k g_k(v_k) at all grid points; g[k] has grid.line(k).points() values, k < grid.dimensions().
void tensor_product(const velocity_grid& grid, double factor, const std::array<const double*, 3>& g,
                    double* m);

}  // namespace apsis
