// Transport past bodies on several processes has the bits of a single one.
#include <apsis/core/errors.hpp>
#include <apsis/core/random_source.hpp>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <semidiscrete/blocks.hpp>
#include <semidiscrete/gas_past_bodies.hpp>

namespace cut_blocks_test {
namespace {

using namespace gas_past_bodies_test;
using apsis::communicator;

choices random_flow(apsis::random_source& random) {
  const std::array<std::string, 3> ends = {"diffuse", "outflow", "symmetry"};
  const auto anywhere = [&] { return random.uniform(-1.0, 1.0); };
  choices one{.dimensions = random.uniform() < 0.3 ? 3 : 2,
              .scheme = random.uniform() < 0.5 ? "weno5-z" : "upwind1",
              .boundary = ends[static_cast<std::size_t>(random.integer(0, 2))],
              .limited = random.uniform() < 0.7,
              .wall = random.uniform() < 0.2 ? "symmetry" : "diffuse"};
  one.cells = one.dimensions == 2 ? random.integer(12, 19) : 10;
  const double depth = one.dimensions == 2 ? 0.0 : 1.0;
  for (int bodies = random.integer(1, 3); bodies > 0; --bodies)
    one.bodies.push_back(ball({anywhere(), anywhere(), depth * anywhere()}, random.uniform(0.3, 0.6)));
  return one;
}

/// Compares 2u + 0.01 T(u) on the blocks and on the whole mesh.
void expect_the_bits_of_one_process(const choices& flow, const std::array<int, 3>& blocks, unsigned seed) {
  std::mt19937 generator(seed);
  const gas_past_bodies whole = make(flow);
  const field u = random_state(whole.mesh(), whole.equation->components(), generator);
  check_blocks(whole, u, blocks,
               [&](const std::shared_ptr<communicator>& processes) { return make(flow, processes, blocks); });
}

}  // namespace

TEST(cut_blocks, have_the_bits_of_one_process_past_random_bodies) {
  apsis::random_source random(4);
  int tested = 0;
  for (unsigned repetition = 0; repetition < 30; ++repetition) {
    const choices flow = random_flow(random);
    // The blocks have a few cells, so groups lie in several of them.
    std::array<int, 3> blocks = {random.integer(1, 5), random.integer(1, 5),
                                 flow.dimensions == 3 ? random.integer(1, 3) : 1};
    try {
      make(flow);
    } catch (const apsis::input_error&) {
      continue;  // the body is refused
    }
    ++tested;
    ASSERT_NO_THROW(expect_the_bits_of_one_process(flow, blocks, repetition)) << repetition;
  }
  EXPECT_GT(tested, 15);
}

TEST(cut_blocks, have_the_bits_of_one_process_across_periodic_faces) {
  const auto discs = either(ball({0.07, -1.0, 0}, 0.5), ball({0.07, 1.0, 0}, 0.5));
  for (const std::array<int, 3>& blocks : {std::array{3, 4, 1}, {1, 2, 1}, {1, 7, 1}})
    ASSERT_NO_THROW(expect_the_bits_of_one_process({.bodies = {discs}}, blocks, 7)) << blocks[1];
}

}  // namespace cut_blocks_test
