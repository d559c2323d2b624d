// Checkpoint, history and manifest contain every number of the state of a run.
#include <apsis/run/manifest.hpp>
#include <apsis/run/records.hpp>

#include <map>
#include <set>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace run_state_test {

namespace {

/// Returns a run stopped in the middle, to a tolerance or with a graded start.
apsis::simulation started_run(const std::string& more = "time.tolerance=1e-4") {
  apsis::simulation run(
      apsis::load_case("paper/ode", {"time.method=md-imex-6-3", "model.epsilon=1e-3", more}));
  for (int k = 0; k < 12; ++k) run.advance();
  return run;
}

template <class Number>
double as_double(const Number& x) {
  return static_cast<double>(x);
}

/// Returns all numbers by group and name.
std::map<std::string, double> numbers_of(const apsis::run_state& state) {
  std::map<std::string, double> all;
  apsis::run_state::visit_records(state, [&all](const std::string& group, const auto& record) {
    record.visit_members(
        record, [&](const std::string& name, const auto& x) { all[group + "." + name] = as_double(x); });
  });
  return all;
}

std::vector<double> row_of(const apsis::step_record& record) {
  std::vector<double> row;
  apsis::step_record::visit_members(record, [&row](const char*, const auto& x) {
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(x)>>)
      row.push_back(as_double(x));
    else
      row.insert(row.end(), x.begin(), x.end());
  });
  return row;
}

}  // namespace

TEST(run_state, survives_a_checkpoint_with_every_number) {
  for (const char* more : {"time.tolerance=1e-4", "time.startup=graded"}) {
    const auto run = started_run(more);
    const apsis::run_records records(run);
    const apsis::run_state before = run.save();
    auto written = make_checkpoint(run, records);
    written.history.rows.push_back(row_of(before.last));  // the records of this test have only the first row
    const apsis::run_state after = to_run_state(written);
    EXPECT_EQ(numbers_of(after), numbers_of(before));
    EXPECT_EQ(after.unknowns, before.unknowns);
    // The comparison is by text, in which NaN (the entropy of this model) equals NaN.
    EXPECT_EQ(fmt::format("{}", fmt::join(row_of(after.last), " ")),
              fmt::format("{}", fmt::join(row_of(before.last), " ")));
    EXPECT_EQ(written.numbers.size(), numbers_of(before).size() + 1) << "and the stride of the history";
  }
  EXPECT_GT(numbers_of(started_run("time.startup=graded").save()).at("march.startup_steps"), 0.0);
  EXPECT_LT(numbers_of(started_run().save()).at("control.proposed"), 1.0);
}

TEST(run_state, a_missing_or_wrong_number_is_a_damaged_checkpoint) {
  const auto run = started_run();
  const auto written = make_checkpoint(run, apsis::run_records(run));
  for (const auto& [name, value] : written.numbers) {
    if (name == "history.stride" || name == "control.proposed") continue;  // absent without a tolerance
    auto lacking = written;
    lacking.numbers.erase(name);
    EXPECT_THROW(to_run_state(lacking), apsis::io_error) << name;
  }
  for (const char* counter : {"march.step", "march.startup_done", "totals.steps", "control.rejected"}) {
    auto wrong = written;
    wrong.numbers[counter] = -1.0;
    EXPECT_THROW(to_run_state(wrong), apsis::io_error) << counter;
    wrong.numbers[counter] = 1e300;
    EXPECT_THROW(to_run_state(wrong), apsis::io_error) << counter;
  }
}

TEST(run_state, the_manifest_contains_every_total_and_the_history_every_check) {
  const auto run = started_run();
  const auto manifest = apsis::manifest(run, {});
  const apsis::run_summary totals = run.summary();
  apsis::run_summary::visit_members(totals, [&](const char* name, const auto& x) {
    ASSERT_TRUE(manifest["result"].contains(name)) << name;
    if (manifest["result"][name].is_null()) return;  // null without entropy
    EXPECT_EQ(manifest["result"][name].template get<double>(), as_double(x)) << name;
  });
  const auto columns = apsis::run_records(run).history().columns;
  EXPECT_EQ(columns.size(), row_of(run.last()).size());
  EXPECT_EQ(std::set<std::string>(columns.begin(), columns.end()).size(), columns.size());
}

}  // namespace run_state_test
