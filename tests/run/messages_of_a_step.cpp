// Messages, bytes and reductions of a step on several processes agree with a formula.
#include <apsis/method/method.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/processes.hpp>

namespace messages_of_a_step_test {

namespace {

using apsis::communication_count;
using apsis::communicator;

/// Returns a case with 12 × 12 cells in 2 × 3 blocks of 6 × 4 cells.
apsis::case_config gas(const std::string& method, const std::string& boundary,
                       const std::vector<std::string>& overrides = {}) {
  return apsis::parse_case(
      fmt::format("[model]\nname = \"bgk\"\nepsilon = 0.1\n[initial]\nrho = \"1 + 0.2*sin(2*pi*x)\"\nu = [0, "
                  "0]\nT = 1\n"
                  "[space]\ncells = [12, 12]\ndomain = [[0, 1], [0, 1]]\nboundary = \"{}\"\n"
                  "limiter = \"positivity\"\n[velocity]\nmax = 6\npoints = 12\n[time]\nmethod = "
                  "\"{}\"\nsafety = 0.5\n"
                  "end = 1.0\n",
                  boundary, method),
      "gas.toml", overrides);
}

/// Returns the number of states whose T enters a later stage.
int evaluations_of_transport(const apsis::method& m) {
  const auto form = m.coefficients<double>();
  int count = 0;
  for (std::size_t j = 0; j < form.stages(); ++j) {
    bool used = false;
    for (std::size_t i = 0; i < form.stages(); ++i) used = used || form.W(i, j) != 0.0;
    count += used ? 1 : 0;
  }
  return count;
}

/// Messages and rows of a process for one evaluation of T.
struct halo {
  long messages, rows;
};

/// There are two blocks of 6 cells along x and three blocks of 4 cells along y. WENO with the limiter needs 4
/// cells beyond a block. Between periodic faces the other block along x is the neighbour on both sides. It
/// sends all 6 planes in one message. Along y all three blocks are neighbours.
halo halo_of(int rank, bool periodic) {
  halo sum{1, (periodic ? 6 : 4) * 4};
  const int place = rank % 3;
  for (int other = 0; other < 3; ++other) {
    if (other == place || (!periodic && std::abs(other - place) == 2)) continue;
    ++sum.messages;
    sum.rows += 4 * 6;
  }
  return sum;
}

void expect_the_formula(const std::string& method, bool periodic) {
  const std::string boundary = periodic ? "periodic" : "diffuse";
  std::vector<communication_count> sent(6);
  // The case is read once, because libstdc++ fills the caches of its locale without synchronisation that
  // ThreadSanitizer detects.
  const auto config = gas(method, boundary, {"space.blocks=[2, 3]"});
  threads_as_processes::run(6, [&](const std::shared_ptr<communicator>& processes) {
    apsis::simulation run(config, {}, processes);
    run.advance();
    const communication_count before = processes->count();
    run.advance();
    const communication_count after = processes->count();
    sent[static_cast<std::size_t>(processes->rank())] = {
        after.messages - before.messages, after.bytes - before.bytes, after.reductions - before.reductions};
  });
  const apsis::run_setup alone(gas(method, boundary));
  const int evaluations = evaluations_of_transport(alone.integrator().starter()),
            stride = alone.initial_state().stride();
  for (int rank = 0; rank < 6; ++rank) {
    const halo each = halo_of(rank, periodic);
    const auto& found = sent[static_cast<std::size_t>(rank)];
    EXPECT_EQ(found.messages, evaluations * each.messages) << method << " on process " << rank;
    EXPECT_EQ(found.bytes, evaluations * each.rows * stride * 8) << method << " on process " << rank;
    EXPECT_EQ(found.reductions, sent[0].reductions);
    // The history and the promises need these reductions, whatever the method.
    EXPECT_LE(found.reductions, 12);
  }
}

}  // namespace

TEST(messages_of_a_step, are_those_of_the_halo_in_every_evaluation_of_transport) {
  for (const std::string method : {"md-imex-3-2", "md-imex-6-3"})
    for (const bool periodic : {false, true}) expect_the_formula(method, periodic);
}

}  // namespace messages_of_a_step_test
