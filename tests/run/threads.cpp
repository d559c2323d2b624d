// The default number of threads of a run.
#include "cases.hpp"

#include <apsis/exec/parallel.hpp>
#include <apsis/run/session.hpp>

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace threads_test {

namespace {

/// Sets OMP_NUM_THREADS during a test and restores it afterwards.
class environment {
 public:
  explicit environment(const char* value) {
    if (const char* const before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~environment() { set(before_.empty() ? nullptr : before_.c_str()); }
  environment(const environment&) = delete;
  environment& operator=(const environment&) = delete;

 private:
  static constexpr const char* name = "OMP_NUM_THREADS";
  static void set(const char* value) { value == nullptr ? unsetenv(name) : setenv(name, value, 1); }
  std::string before_;
};

}  // namespace

TEST(threads_for, a_case_follow_the_environment_or_its_size) {
  auto c = small("md-imex-3-2", "finite-difference");
  {
    const environment three("3,2");
    EXPECT_EQ(apsis::threads_for(c), 3);
    EXPECT_EQ(apsis::default_threads(), 3);
  }
  for (const char* wrong : {"0", "-4", "many", "2x", ""}) {
    const environment nothing(wrong);
    EXPECT_EQ(apsis::requested_threads(), 0) << wrong;
    EXPECT_EQ(apsis::threads_for(c), 1) << wrong;
  }
  const environment large("99999999999999999999");
  EXPECT_EQ(apsis::threads_for(c), apsis::most_threads);
  const environment none(nullptr);
  EXPECT_EQ(apsis::threads_for(c), 1);
  c.space.cells = {40000};
  EXPECT_EQ(apsis::threads_for(c), apsis::default_threads());
  c.space.cells = {20};
  c.model.parameters["velocity_dimensions"] = 3;  // 36³ velocities
  EXPECT_EQ(apsis::threads_for(c), apsis::default_threads());
}

}  // namespace threads_test
