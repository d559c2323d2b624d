// The limiter of a cell beside a solid box changes a flux that another sweep computes too. Mass must be
// conserved across a periodic face, and across the border of two boxes of cells that are swept in turn.
#include "laws.hpp"

#include <string>

#include <gtest/gtest.h>

namespace conservation_beside_solids_test {

namespace {

const char* const beside_a_box = R"toml(
[model]
name = "bgk"
epsilon = 0.1
[initial]
rho = "x + 0.3*y < 1.5 ? 1e-6 : 1"
u = [0.5, 0.2]
T = 1
[space]
cells = [30, 8]
domain = [[0, 3], [0, 0.8]]
limiter = "positivity"
reconstruction = "upwind5"
[[space.solid]]
kind = "inflow"
rho = "0.03*(1 + 0.7*sin(3*x + 3*y - 7*t))"
T = 1
[velocity]
max = 7
points = 14
[time]
method = "md-imex-3-2"
safety = 1
end = 0.02
)toml";

/// Returns the conservation defect of a run with a solid box.
double defect(const std::string& from, const std::string& to) {
  return finished_run(beside_a_box, {"space.solid.1.from=" + from, "space.solid.1.to=" + to})
      .summary()
      .conservation_defect;
}

}  // namespace

// About 30 steps of 3 stages. The unlimited and the limited flux differ by 1e-7 of the mass.
constexpr double rounding = 1e-13;

TEST(conservation_beside_solids, holds_one_cell_from_a_periodic_face) {
  EXPECT_LT(defect("[0.1, 0.2]", "[1.5, 0.6]"), rounding);
  EXPECT_LT(defect("[1.5, 0.2]", "[2.9, 0.6]"), rounding);
}

TEST(conservation_beside_solids, holds_one_cell_from_the_middle_of_the_mesh) {
  // The 30 cells are swept as two boxes of 15.
  EXPECT_LT(defect("[0.6, 0.2]", "[1.4, 0.6]"), rounding);
  EXPECT_LT(defect("[1.6, 0.2]", "[2.4, 0.6]"), rounding);
}

}  // namespace conservation_beside_solids_test
