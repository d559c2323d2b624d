// A uniform stream along the axis, without collisions.
#include "polar_gas.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace axisymmetric_streams_test {

using namespace polar_gas_test;

TEST(axisymmetric_streams, along_the_axis_stay_uniform_to_rounding) {
  // Reconstructions of a higher order are exact for F = r f. The bounds are those of a gas at rest.
  for (const int dimensions : {1, 2})
    for (const std::string scheme : {"upwind5", "weno5-z"})
      for (const bool limited : {false, true})
        for (const std::string outer : {"diffuse", "inflow", "outflow"})
          for (const std::string ends : {"periodic", "inflow", "outflow"})
            for (const double inner : {0.0, 0.3}) {
              if (dimensions == 1 && ends != "periodic") continue;
              const polar_flow flow = make({.dimensions = dimensions,
                                            .inner = inner,
                                            .scheme = scheme,
                                            .limited = limited,
                                            .outer = outer,
                                            .ends = ends,
                                            .speed = 0.7});
              const field u = flow.stream(0.7), change = flow.step(u, 0.0, 1.0);
              EXPECT_LT(largest(change), limited ? 1e-11 : 1e-13)
                  << dimensions << scheme << limited << outer << ends << inner;
              // Of f = F/r in the cells at the axis, whose r is the smallest.
              for (int cell = 0; cell < u.cells() && inner == 0.0; ++cell)
                for (int k = 0; k < u.components() && flow.r(cell) < 0.1; ++k)
                  EXPECT_LT(std::abs(change.row(cell)[k]) / flow.r(cell), limited ? 1e-10 : 1e-12)
                      << dimensions << scheme << limited << outer << ends;
            }
}

}  // namespace axisymmetric_streams_test
