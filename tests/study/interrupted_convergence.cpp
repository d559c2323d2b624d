// An interrupted study stops within a step and retains its finished runs.
#include <apsis/exec/parallel.hpp>
#include <apsis/study/convergence.hpp>

#include <gtest/gtest.h>

namespace interrupted_convergence_test {

using namespace apsis;

TEST(interrupted_convergence, stops_between_steps_and_retains_finished_runs) {
  set_threads(1);
  convergence study({.case_name = "paper/ode",
                     .vary = {parse_vary("time.dt=1/16..1/64")},
                     .reference = parse_reference("time.dt=1/128")});
  // The longest run is the first, with 128 steps to t = 1. The next one has 64. The study queries before each
  // run and each step, so it stops within the second run.
  int asked = 0;
  study_control control;
  control.stop = [&asked] { return ++asked > 128 + 32; };
  const long runs = study.table().runs;
  EXPECT_THROW(study.run(control), study_interrupted);
  EXPECT_EQ(study.finished_runs(), 1);
  EXPECT_FALSE(study.table().complete);
  // The next call computes the remaining runs. The result equals that of an uninterrupted study.
  study.run();
  EXPECT_EQ(study.finished_runs(), runs);
  const convergence_table table = study.table();
  EXPECT_TRUE(table.complete);
  convergence whole({.case_name = "paper/ode",
                     .vary = {parse_vary("time.dt=1/16..1/64")},
                     .reference = parse_reference("time.dt=1/128")});
  whole.run();
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(table.blocks[0].rows[k].error, whole.table().blocks[0].rows[k].error);
}

}  // namespace interrupted_convergence_test
