// Every test begins with a team of three: most set no number of threads, and one thread has no races.
// Compiled into the tests that run under the thread sanitizer only.
#include <apsis/exec/parallel.hpp>

#include <gtest/gtest.h>

namespace {

class team_of_three : public testing::Environment {
 public:
  void SetUp() override { apsis::set_threads(3); }
};

[[maybe_unused]] const auto* const registered = testing::AddGlobalTestEnvironment(new team_of_three);

}  // namespace
