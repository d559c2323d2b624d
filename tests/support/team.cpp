// Sets three threads before all tests. Most tests set no number of threads, and one thread has no data races.
// Only tests under the thread sanitizer compile this file.
#include <apsis/exec/parallel.hpp>

#include <gtest/gtest.h>

namespace {

class team_of_three : public testing::Environment {
 public:
  void SetUp() override { apsis::set_threads(3); }
};

[[maybe_unused]] const auto* const registered = testing::AddGlobalTestEnvironment(new team_of_three);

}  // namespace
