// Sizes at the limits of the index types. The tests do not allocate the memory.
#include "cases.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/model/maxwellian.hpp>

#include <new>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

namespace sizes_test {

namespace {

template <class Function>
std::string refusal(const Function& make) {
  try {
    make();
  } catch (const apsis::input_error& refused) {
    return refused.what();
  }
  return "";
}

}  // namespace

TEST(sizes, too_many_velocities_are_refused_with_the_largest_number) {
  for (const auto& [dimensions, points, most] :
       {std::tuple{3, 1025, "1024"}, std::tuple{3, 1291, "1024"}, std::tuple{3, 2000000000, "1024"},
        std::tuple{2, 32769, "32768"}, std::tuple{1, 2000000000, "1073741824"}}) {
    auto c = small("md-imex-3-2", "finite-difference");
    c.model.parameters["velocity_dimensions"] = dimensions;
    c.velocity.points = points;
    const std::string message = refusal([&] { apsis::simulation run(c); });
    EXPECT_NE(message.find("velocity.points = " + std::to_string(points) + " are "), std::string::npos)
        << message;
    EXPECT_NE(message.find(std::string("give at most ") + most), std::string::npos) << message;
  }
}

TEST(sizes, too_many_cells_are_refused) {
  EXPECT_EQ(apsis::grid(3, {1024, 1024, 1024}, {0, 0, 0}, {1, 1, 1}).size(), 1 << 30);
  const std::string message = refusal([] { apsis::grid(3, {1024, 1024, 1025}, {0, 0, 0}, {1, 1, 1}); });
  EXPECT_NE(message.find("1.075e+09 cells (more than 1073741824 cannot be numbered)"), std::string::npos)
      << message;
}

TEST(sizes, a_field_larger_than_the_address_space_is_not_an_internal_error) {
  EXPECT_THROW(apsis::field(1 << 30, 1 << 30), std::bad_alloc);
}

TEST(sizes, blocks_of_the_longest_range_cover_it) {
  constexpr int n = 2147483647;
  for (const int longest : {1, 4, 4096, n})
    for (const int parts : {1, 2, 256}) {
      const apsis::part_blocks blocks(n, longest, parts);
      if (longest == 1 && parts > 1) continue;  // the number of blocks overflows
      EXPECT_EQ(blocks.begin(0), 0);
      EXPECT_EQ(blocks.begin(blocks.count()), n) << longest << " " << parts;
      for (const int block : {0, blocks.count() / 2, blocks.count() - 1}) {
        EXPECT_LE(blocks.begin(block), blocks.end(block)) << longest << " " << parts;
        EXPECT_LE(blocks.end(block) - blocks.begin(block), longest) << longest << " " << parts;
      }
    }
}

TEST(sizes, a_row_of_a_million_velocities_is_transported) {
  // The product of columns and vectors of a row is 32 768 times 131 072 here, which exceeds 32 bits.
  auto c = small("ssprk-3-3", "finite-difference");
  c.model.epsilon = "1e12";
  c.space.cells = {7};
  c.space.limiter = apsis::limiter_choice::none;
  c.velocity = {9.0, 1 << 20, apsis::equilibrium_choice::formula};
  c.time.end = 1e-5;
  c.time.cfl.reset();
  c.time.dt = 1e-5;
  apsis::simulation run(c);
  run.advance();
  EXPECT_LE(run.last().conservation_defect[0], 1e-13);
  EXPECT_GE(run.last().min_value, -1e-15);  // undershoots of WENO where f is zero up to rounding
}

}  // namespace sizes_test
