// A uniform gas without collisions, at rest or in a stream along the axis, stays uniform.
#include "polar_gas.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace axisymmetric_streams_test {
namespace {

using namespace polar_gas_test;

/// Checks F = r f with the f that walls emit. The terms are speeds of 1.7/Δr, and of rotation, 1.3 · 16/(2π
/// r), times values up to 1. They are some tens. Limited fluxes have margins of 1e-13 of them.
/// Reconstructions of higher order are exact for F. `ends` are kinds at the ends of the axis.
void expect_uniform(double speed, const std::vector<std::string>& ends) {
  for (const int dimensions : {1, 2})
    for (const std::string scheme : {"upwind5", "weno5-z"})
      for (const bool limited : {false, true})
        for (const std::string outer : {"diffuse", "inflow", "outflow"})
          for (const std::string& end : ends)
            for (const double inner : {0.0, 0.3}) {
              if (dimensions == 1 && end != "periodic") continue;
              const polar_flow flow = make({.dimensions = dimensions,
                                            .inner = inner,
                                            .scheme = scheme,
                                            .limited = limited,
                                            .outer = outer,
                                            .ends = end,
                                            .speed = speed});
              const std::string where =
                  fmt::format("{} {} {} {} {} {}", dimensions, scheme, limited, outer, end, inner);
              const field u = flow.stream(speed), change = flow.step(u, 0.0, 1.0);
              EXPECT_LT(largest(change), limited ? 1e-11 : 1e-13) << where;
              // The change of f = F/r is checked at the axis, where r is smallest.
              for (int cell = 0; cell < u.cells() && inner == 0.0; ++cell)
                for (int k = 0; k < u.components() && flow.r(cell) < 0.1; ++k)
                  EXPECT_LT(std::abs(change.row(cell)[k]) / flow.r(cell), limited ? 1e-10 : 1e-12) << where;
            }
}

}  // namespace

TEST(axisymmetric_streams, at_rest_stay_uniform_to_rounding) {
  expect_uniform(0.0, {"periodic", "diffuse", "symmetry", "inflow", "outflow"});
}

TEST(axisymmetric_streams, along_the_axis_stay_uniform_to_rounding) {
  expect_uniform(0.7, {"periodic", "inflow", "outflow"});
}

}  // namespace axisymmetric_streams_test
