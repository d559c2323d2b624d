// Lets several threads share the loops over the small fields of tests. They would otherwise run
// on one thread.
#include <apsis/exec/parallel.hpp>

#include <gtest/gtest.h>

namespace shared_loops_test {

class shared_loops : public testing::Environment {
 public:
  void SetUp() override { apsis::share_loops_from(0); }
};

[[maybe_unused]] const auto* const registered = testing::AddGlobalTestEnvironment(new shared_loops);

}  // namespace shared_loops_test
