// Steady states past bodies on several processes agree with those of one process, below the tolerance.
#include "flows_past_bodies.hpp"

#include <apsis/core/errors.hpp>
#include <apsis/core/random_source.hpp>
#include <apsis/steady/steady_solver.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/processes.hpp>

namespace bodies_on_processes_test {
namespace {

using namespace flows_past_bodies_test;
using apsis::at;
using apsis::communicator;

constexpr double tolerance = 1e-9;
/// Iterates differ from the state by the tolerance times the number of iterations that an error survives. The
/// measured maximum is 3.3 tolerances, relative to the largest value.
constexpr double close = 20.0 * tolerance;
/// Largest number of iterations relative to one process. The measured maximum is 1.6. Free flight crosses one
/// block in an iteration.
constexpr double most_iterations = 2.0;

/// A steady state of the whole mesh.
struct steady_state {
  field f;
  std::vector<double> loads;  ///< the amount of each invariant that each body receives
  int iterations = 0;
  apsis::removed_values removed = {};
};

/// Adds the amounts that bodies receive at the ends of a process.
void add_loads(const gas_past_bodies& gas, std::vector<double>& to) {
  const auto rates = gas.problem->budget_rates();
  const std::size_t count = gas.equation->invariants().size();
  to.resize(at(gas.mesh().obstacles()) * count);
  std::size_t next = 0;
  for (const auto& surface : gas.builder->space().budget_surfaces())
    for (std::size_t end = 0; end < gas.builder->space().ends_at(surface); ++end)
      for (std::size_t k = 0; k < count; ++k, ++next)
        if (surface.solid >= 0) to[at(surface.solid) * count + k] += rates[next];
}

double farthest(const field& a, const field& b) {
  double most = 0.0;
  for (int cell = 0; cell < a.cells(); ++cell)
    for (int k = 0; k < a.components(); ++k) most = std::max(most, std::abs(a.row(cell)[k] - b.row(cell)[k]));
  return most;
}

steady_state solve(const choices& flow, double ux) {
  const gas_past_bodies gas = make(flow);
  const field start = gas.uniform(ux);
  steady_state found{start, {}, 0};
  apsis::steady_solver solver(*gas.equation, *gas.builder, *gas.problem, found.f, {.tolerance = tolerance});
  found.iterations = solver.solve(found.f).number;
  EXPECT_GT(farthest(found.f, start), 1e-3);
  gas.step(found.f, 0.0, 1.0);
  add_loads(gas, found.loads);
  return found;
}

/// Finds the state on the processes of these blocks.
steady_state solve(const choices& flow, double ux, const blocks_of_mesh& blocks, double to = tolerance) {
  const gas_past_bodies whole = make(flow);
  steady_state found{whole.uniform(), {}, 0};
  std::mutex adds;
  threads_as_processes::run(
      blocks[0] * blocks[1] * blocks[2], [&](const std::shared_ptr<communicator>& processes) {
        const gas_past_bodies part = make(flow, processes, blocks);
        field f = part.uniform(ux);
        apsis::steady_solver solver(*part.equation, *part.builder, *part.problem, f, {.tolerance = to});
        const apsis::steady_iteration last = solver.solve(f);
        part.step(f, 0.0, 1.0);
        const std::lock_guard lock(adds);
        add_loads(part, found.loads);
        found.iterations = last.number;
        found.removed = last.removed;
        for (int cell = 0; cell < f.cells(); ++cell)
          std::copy_n(f.row(cell), f.stride(), found.f.row(whole.mesh().cell_of(part.mesh(), cell)));
      });
  return found;
}

/// Expects that cells of a group have equal rows, whichever processes own them.
void expect_equal_rows(const choices& flow, const field& f) {
  const gas_past_bodies gas = make(flow);
  for (const apsis::cut_group& group : gas.mesh().cut()->groups())
    for (const int cell : group.cells)
      ASSERT_TRUE(std::equal(f.row(cell), f.row(cell) + f.components(), f.row(group.cells.front()))) << cell;
}

void expect_close(const steady_state& alone, const steady_state& shared) {
  EXPECT_LT(farthest(shared.f, alone.f), close * largest(alone.f));
  double scale = 0.0;
  for (const double load : alone.loads) scale = std::max(scale, std::abs(load));
  ASSERT_EQ(shared.loads.size(), alone.loads.size());
  for (std::size_t k = 0; k < alone.loads.size(); ++k)
    EXPECT_NEAR(shared.loads[k], alone.loads[k], close * std::max(1.0, scale)) << k;
  EXPECT_LE(shared.iterations, most_iterations * alone.iterations);
}

named_flow random_flow(apsis::random_source& random, int number) {
  const int cells = random.integer(10, 16);
  std::vector<outside_function> bodies;
  for (int k = random.integer(1, 3); k > 0; --k) {
    const double x = random.uniform(-0.8, 0.8), y = random.uniform(-0.8, 0.8);
    bodies.push_back(ball({x, y, 0}, random.uniform(0.25, 0.5)));
  }
  choices one = in_stream(std::move(bodies), cells, random.magnitude(-1.5, 1.5), 0.3);
  one.scheme = "upwind1";  // bodies may leave gaps of a cell or two, where other schemes hardly settle
  one.accommodation = random.uniform() < 0.3 ? 0.4 : 1.0;
  if (random.uniform() < 0.3) one.wall = "symmetry";
  const int along = random.integer(1, 4), across = random.integer(2, 4);
  return {fmt::format("random flow {}", number), one, 0.3, {{along, across, 1}}};
}

void expect_those_of_one_process(const named_flow& flow) {
  const steady_state alone = solve(flow.of, flow.ux);
  for (const blocks_of_mesh& blocks : flow.blocks) {
    const testing::ScopedTrace trace(__FILE__, __LINE__,
                                     fmt::format("{}, {} x {} blocks", flow.name, blocks[0], blocks[1]));
    const steady_state shared = solve(flow.of, flow.ux, blocks);
    expect_equal_rows(flow.of, shared.f);
    expect_close(alone, shared);
    if (flow.of.limited) {
      EXPECT_GE(least_value(shared.f), 0.0);
    }
  }
}

}  // namespace

TEST(steady_bodies_on_processes, agree_with_one_process_past_random_bodies) {
  apsis::random_source random(11);
  int tested = 0;
  for (int number = 0; number < 12; ++number) {
    const named_flow flow = random_flow(random, number);
    try {
      make(flow.of);
    } catch (const apsis::input_error&) {
      continue;  // the body is refused
    }
    ++tested;
    expect_those_of_one_process(flow);
  }
  EXPECT_GT(tested, 6);
}

TEST(steady_bodies_on_processes, end_together_where_one_process_has_no_equilibrium) {
  const choices flow = warm({disc}, 12, 1.0);
  const int bad = 12 + 5;  // a whole cell of the second process, numbered in the whole mesh
  std::atomic<int> ended = 0;
  threads_as_processes::run(3, [&](const std::shared_ptr<communicator>& processes) {
    const gas_past_bodies gas = make(flow, processes, blocks_of_mesh{1, 3, 1});
    field f = gas.uniform();
    apsis::steady_solver solver(*gas.equation, *gas.builder, *gas.problem, f);
    solver.iterate(f);
    for (int cell = 0; cell < f.cells(); ++cell)
      if (gas.builder->whole_mesh().cell_of(gas.mesh(), cell) == bad)
        for (int k = 0; k < f.components(); ++k) f.row(cell)[k] *= -1.0;
    try {
      solver.iterate(f);
    } catch (const apsis::numerical_error& failure) {
      EXPECT_EQ(failure.site().cell, bad);
      ++ended;
    }
  });
  EXPECT_EQ(ended, 3);
}

TEST(steady_bodies_on_processes, have_equal_rows_where_values_below_0_are_removed) {
  choices flow = in_stream({disc}, 16, 0.1, 1.5);
  flow.limited = true;
  constexpr double loose = 1e-3;  // leaves negative values
  const steady_state shared = solve(flow, 1.5, {4, 1, 1}, loose);
  EXPECT_GT(shared.removed.count, 0);
  EXPECT_GE(least_value(shared.f), 0.0);
  expect_equal_rows(flow, shared.f);
}

TEST(steady_bodies_on_processes, are_those_of_one_process) {
  for (named_flow flow : flows()) {
    if (flow.blocks.size() == 1) continue;  // other blocks are slow
    flow.blocks.erase(flow.blocks.begin(), flow.blocks.end() - 1);
    expect_those_of_one_process(flow);
  }
}

TEST(SLOW_steady_bodies_on_processes, are_those_of_one_process) {
  for (const named_flow& flow : flows()) expect_those_of_one_process(flow);
}

}  // namespace bodies_on_processes_test
