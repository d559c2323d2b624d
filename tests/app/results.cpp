#include "program.hpp"

#include <apsis/output/hdf5_file.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <random>
#include <regex>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace results_test {

using namespace app_test;
using nlohmann::json;
using testing::HasSubstr;

namespace {

namespace fs = std::filesystem;

// The case is large enough for hundreds of steps and small enough for a second.
const std::vector<std::string> small = {"run", "paper/bgk-mixed", "space.cells=20", "velocity.points=100"};

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

/// Compares all numbers and the case, but not the manifest in the file, which contains the time of writing.
void expect_same_solution(const fs::path& a, const fs::path& b) {
  const auto one = apsis::hdf5_file::open(a.string()), other = apsis::hdf5_file::open(b.string());
  ASSERT_EQ(one.datasets(), other.datasets());
  EXPECT_GE(one.datasets().size(), 3U);
  for (const auto& name : one.datasets()) {
    ASSERT_EQ(one.extents(name), other.extents(name)) << name;
    const auto x = one.read(name), y = other.read(name);
    EXPECT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof(double)), 0) << name;
  }
  EXPECT_EQ(one.attributes(), other.attributes());
  EXPECT_EQ(one.read_text_attribute("case"), other.read_text_attribute("case"));
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  if (fs::exists(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void expect_same_results(const fs::path& a, const fs::path& b) {
  for (const std::string name : {"history.csv", "fields.csv", "solution.xdmf"}) {
    ASSERT_FALSE(read(a / name).empty()) << name;
    EXPECT_TRUE(read(a / name) == read(b / name)) << name;
  }
  expect_same_solution(a / "solution.h5", b / "solution.h5");
  ASSERT_EQ(names_in(a / "snapshots"), names_in(b / "snapshots"));
  for (const auto& name : names_in(a / "snapshots"))
    EXPECT_TRUE(read(a / "snapshots" / name) == read(b / "snapshots" / name)) << name;
}

/// Checks that every dataset of the description exists with the stated size, and returns their number.
int check_references(const fs::path& folder) {
  const std::string text = read(folder / "solution.xdmf");
  static const std::regex item("Precision=\"([48])\" Dimensions=\"([0-9 ]+)\">([^:<]+):/([^<]+)<");
  int found = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), item); at != std::sregex_iterator(); ++at, ++found) {
    const auto file = apsis::hdf5_file::open((folder / (*at)[3].str()).string());
    const std::string name = (*at)[4].str();
    std::uint64_t said = 1, there = 1;
    std::istringstream dimensions((*at)[2].str());
    for (std::uint64_t n = 0; dimensions >> n;) said *= n;
    for (const auto n : file.extents(name)) there *= n;
    EXPECT_EQ(said, there) << at->str();
    EXPECT_EQ((*at)[1].str() == "4", file.stored(name) == apsis::precision::float32) << at->str();
  }
  return found;
}

}  // namespace

TEST(results, json_is_one_object_and_the_only_output) {
  const work_folder folder;
  const outcome result = run_apsis(folder, with(small, {"time.end=0.005", "--json"}));
  ASSERT_EQ(result.code, 0) << result.err;
  const json object = json::parse(result.out);
  for (const std::string key : {"case", "method", "steps", "startup_steps", "rejected_steps", "dt", "t",
                                "wall_s", "min_value", "negative_values", "conservation_defect",
                                "max_entropy_increase", "phase_points", "point_stages_per_s", "fields"})
    EXPECT_TRUE(object.contains(key)) << key;
  EXPECT_EQ(object["t"].get<double>(), 0.005);
  EXPECT_EQ(object["phase_points"].get<long>(), 20 * 100);
  EXPECT_EQ(object["negative_values"].get<long>(), 0);
  for (const std::string field : {"x", "rho", "u", "T"})
    EXPECT_EQ(object["fields"][field].size(), 20U) << field;
  EXPECT_FALSE(object.contains("state"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(results, the_state_of_an_ode_is_printed_with_every_digit) {
  const work_folder folder;
  const outcome result =
      run_apsis(folder, {"run", "paper/decay", "time.method=imdrk-1-2", "time.dt=2.0", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const double u = json::parse(result.out)["state"][0].get<double>();
  // One step of u = 10 - dt 10 u² - dt²/2 200 u³ with dt = 2. The residual adds terms of size 10, so it has
  // some rounding errors of 1e-15.
  EXPECT_NEAR(10.0 - 20.0 * u * u - 400.0 * u * u * u - u, 0.0, 1e-13);
}

TEST(results, warnings_are_printed_and_listed) {
  const work_folder folder;
  // 0.3 does not divide the end, and there is no folder for checkpoints.
  const std::vector<std::string> decay = {"run", "paper/decay", "time.method=imdrk-1-2", "time.dt=0.3"};
  const outcome printed = run_apsis(folder, with(decay, {"output.checkpoint_every=1", "--json"})),
                stored = run_apsis(folder, with(decay, {"--out", "o"})),
                silent = run_apsis(folder, {"run", "paper/decay", "time.dt=0.5", "--json"});
  const json listed = json::parse(printed.out)["warnings"];
  ASSERT_EQ(listed.size(), 2U) << printed.err;
  EXPECT_THAT(listed[0].get<std::string>(),
              HasSubstr("time.dt = 0.29999999999999999 does not divide time.end"));
  EXPECT_THAT(listed[1].get<std::string>(), HasSubstr("no checkpoints are written"));
  for (const json& one : listed)
    EXPECT_THAT(printed.err, HasSubstr("warning: " + one.get<std::string>() + "\n"));
  EXPECT_EQ(stored.code, 0) << stored.err;
  EXPECT_EQ(json::parse(read(folder.path() / "o/manifest.json"))["warnings"], json::array({listed[0]}));
  EXPECT_EQ(json::parse(silent.out)["warnings"], json::array());
}

TEST(results, files_agree_with_each_other) {
  const work_folder folder;
  ASSERT_EQ(run_apsis(folder, with(small, {"time.end=0.004", "output.every=0.002", "--out", "o"})).code, 0);
  const json manifest = json::parse(read(folder.path() / "o/manifest.json"));
  EXPECT_EQ(manifest["state"], "complete");
  EXPECT_EQ(manifest["case"]["space"]["cells"], 20);
  const auto history = lines(read(folder.path() / "o/history.csv"));
  EXPECT_EQ(history[0],
            "step,t,dt,min_value,negative_values,conservation_mass,conservation_momentum,conservation_energy,"
            "entropy,"
            "entropy_change,change,total_mass,total_momentum,total_energy");
  // The file has a header, the initial state, and every step.
  EXPECT_EQ(history.size(), 2 + manifest["result"]["steps"].get<std::size_t>());
  const auto fields = lines(read(folder.path() / "o/fields.csv"));
  EXPECT_EQ(fields[0], "t,x,rho,u,T,heat_flux");
  EXPECT_EQ(fields.size(), 1U + 3 * 20);

  const auto file = apsis::hdf5_file::open((folder.path() / "o/solution.h5").string());
  EXPECT_EQ(file.extents("f"), (apsis::hdf5_file::shape{20, 100}));
  const auto f = file.read("f"), v = file.read("v"), rho = file.read("fields/rho"), x = file.read("x");
  EXPECT_EQ(file.extents("snapshots/rho"), (apsis::hdf5_file::shape{3, 20}));
  const double dv = v[1] - v[0];
  for (std::size_t cell = 0; cell < 20; ++cell) {
    double mass = 0.0;
    for (std::size_t k = 0; k < 100; ++k) mass += f[cell * 100 + k] * dv;
    EXPECT_NEAR(mass, rho[cell], 1e-13);  // sums of a hundred terms below 1, in another order
    double csv_t = 0, csv_x = 0, csv_rho = 0;
    ASSERT_EQ(std::sscanf(fields[41 + cell].c_str(), "%lf,%lf,%lf", &csv_t, &csv_x, &csv_rho), 3);
    EXPECT_EQ(csv_x, x[cell]);
    EXPECT_EQ(csv_rho, rho[cell]);
  }
  EXPECT_THAT(read(folder.path() / "o/solution.xdmf"), HasSubstr("Dimensions=\"1 20 100\""));
}

TEST(results, a_solution_carries_its_case_and_its_manifest) {
  const work_folder folder;
  ASSERT_EQ(run_apsis(folder, with(small, {"time.end=0.004", "--out", "o"})).code, 0);
  const auto file = apsis::hdf5_file::open((folder.path() / "o/solution.h5").string());
  EXPECT_EQ(file.read_text_attribute("manifest"), read(folder.path() / "o/manifest.json"));
  // The case in the file is complete: a run of it gives the same numbers.
  folder.file("again.toml", file.read_text_attribute("case"));
  ASSERT_EQ(run_apsis(folder, {"run", "again.toml", "--out", "p"}).code, 0);
  expect_same_solution(folder.path() / "o/solution.h5", folder.path() / "p/solution.h5");
  EXPECT_GT(check_references(folder.path() / "o"), 5);
}

TEST(results, snapshots_of_the_distribution_are_of_some_cells_and_of_the_chosen_precision) {
  const work_folder folder;
  const auto run = with(small, {"time.end=0.006", "output.every=0.002"});
  ASSERT_EQ(run_apsis(folder, with(run, {"output.distribution=snapshots", "--out", "all"})).code, 0);
  ASSERT_EQ(run_apsis(folder, with(run, {"output.distribution=snapshots", "output.stride=3",
                                         "output.precision=single", "--out", "some"}))
                .code,
            0);
  const auto names = names_in(folder.path() / "all/snapshots");
  ASSERT_EQ(names.size(), 4U);
  EXPECT_EQ(names, names_in(folder.path() / "some/snapshots"));
  for (const auto& name : names) {
    const auto all = apsis::hdf5_file::open((folder.path() / "all/snapshots" / name).string());
    const auto some = apsis::hdf5_file::open((folder.path() / "some/snapshots" / name).string());
    EXPECT_EQ(all.read_attribute("t"), some.read_attribute("t"));
    EXPECT_EQ(some.extents("f"), (apsis::hdf5_file::shape{7, 100}));
    const auto f = all.read("f"), g = some.read("f"), x = all.read("x"), y = some.read("x");
    for (std::size_t cell = 0; cell < 7; ++cell) {
      EXPECT_EQ(y[cell], x[3 * cell]);
      for (std::size_t k = 0; k < 100; ++k)
        ASSERT_EQ(static_cast<float>(f[300 * cell + k]), static_cast<float>(g[100 * cell + k]));
    }
  }
  // The last snapshot is the final state, with every digit of every cell.
  const auto last = apsis::hdf5_file::open((folder.path() / "all/snapshots" / names.back()).string());
  const auto end = apsis::hdf5_file::open((folder.path() / "some/solution.h5").string());
  EXPECT_EQ(last.read("f"), end.read("f"));
  for (const std::string which : {"all", "some"}) EXPECT_GT(check_references(folder.path() / which), 20);
  // A run without snapshots removes those of an earlier run.
  ASSERT_EQ(run_apsis(folder, with(run, {"output.distribution=none", "--out", "all"})).code, 0);
  EXPECT_FALSE(fs::exists(folder.path() / "all/snapshots"));
  EXPECT_FALSE(apsis::hdf5_file::open((folder.path() / "all/solution.h5").string()).has("f"));
}

/// The runs share no kernel of transport or collision. They have point values, averages with collisions at
/// Gauss points and at centres, laws with formulas, and a gas between walls.
TEST(results, two_runs_and_any_number_of_threads_give_the_same_bits) {
  const std::vector<std::vector<std::string>> runs = {
      with(small, {"time.end=0.005"}),
      with(small, {"time.end=0.005", "space.formulation=finite-difference"}),
      with(small, {"time.end=0.005", "space.collisions=centres"}),
      {"run", "laws/euler-sod", "space.cells=700", "time.end=0.02"},
      {"run", "paper/relaxation", "model.flux=sin(u)/2 + u^3/9", "space.cells=700", "time.end=0.02"},
      {"run", "gas/cavity", "space.cells=[20,17]", "velocity.points=[12,12]", "time.end=0.02"}};
  for (const auto& run : runs) {
    SCOPED_TRACE(run.at(1) + " " + run.back());
    const work_folder folder;
    ASSERT_EQ(run_apsis(folder, with(run, {"--threads", "1", "--out", "a"})).code, 0);
    ASSERT_EQ(run_apsis(folder, with(run, {"--threads", "1", "--out", "b"})).code, 0);
    ASSERT_EQ(run_apsis(folder, with(run, {"--threads", "3", "--out", "c"})).code, 0);
    expect_same_results(folder.path() / "a", folder.path() / "b");
    expect_same_results(folder.path() / "a", folder.path() / "c");
  }
}

TEST(results, a_run_states_its_number_of_threads) {
  const work_folder folder;
  const auto said = [&](const std::vector<std::string>& more) {
    return run_apsis(folder, with(small, with({"time.end=0.001"}, more))).err;
  };
  EXPECT_THAT(said({"--threads", "1"}), HasSubstr(" on 1 thread; "));
  EXPECT_THAT(said({"--threads", "2"}), HasSubstr(" on 2 threads; "));
}

TEST(results, only_chosen_fields_are_written) {
  const work_folder folder;
  ASSERT_EQ(run_apsis(folder, with(small, {"time.end=0.001", "output.fields=[\"T\"]", "--out", "o"})).code,
            0);
  EXPECT_EQ(lines(read(folder.path() / "o/fields.csv"))[0], "x,T");
}

class interruption : public testing::TestWithParam<int> {};

TEST_P(interruption, gives_130_and_a_checkpoint_that_continues_bit_for_bit) {
  const work_folder folder;
  // The signal comes when the first checkpoint exists, after the first step and long before the end
  // of the run.
  const fs::path checkpoint = folder.path() / "stopped/checkpoint.h5";
  process run(folder, with(small, {"time.end=50.0", "output.every=0.01", "output.checkpoint_every=1", "--out",
                                   "stopped"}));
  ASSERT_TRUE(run.wait_until([&] { return fs::exists(checkpoint); }));
  run.send(GetParam());
  const outcome stopped = run.wait();
  ASSERT_EQ(stopped.code, 130) << stopped.err;
  const json manifest = json::parse(read(folder.path() / "stopped/manifest.json"));
  EXPECT_EQ(manifest["state"], "interrupted");
  const double t = manifest["result"]["t"].get<double>();
  ASSERT_GT(t, 0.0);
  const std::string end = "time.end=" + std::to_string(t + 0.02);
  const outcome resumed = run_apsis(folder, with(small, {end, "output.every=0.01", "--restart",
                                                         "stopped/checkpoint.h5", "--out", "resumed"}));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  ASSERT_EQ(run_apsis(folder, with(small, {end, "output.every=0.01", "--out", "whole"})).code, 0);
  expect_same_results(folder.path() / "whole", folder.path() / "resumed");
}

TEST(results, fifty_kills_at_random_moments_lose_nothing) {
  const work_folder folder;
  const auto long_run = with(small, {"time.end=3.0", "output.every=0.01", "output.distribution=snapshots"});
  ASSERT_EQ(run_apsis(folder, with(long_run, {"--out", "whole"})).code, 0);
  std::mt19937 random(2026);
  std::uniform_int_distribution<int> milliseconds(0, 100);
  const fs::path saved = folder.path() / "o/checkpoint.h5";
  const auto go_on = [&](const std::string& checkpoints) {
    auto arguments = with(long_run, {"output.checkpoint_every=" + checkpoints, "--out", "o"});
    return fs::exists(saved) ? with(arguments, {"--restart", "o/checkpoint.h5"}) : arguments;
  };
  int kills = 0, in_steps = 0;
  for (int attempt = 0; attempt < 50; ++attempt) {
    const std::string before = read(saved);
    process run(folder, go_on("1"));
    // Every second run completes at least its first step before it is killed at a random moment.
    if (attempt % 2 == 0) {
      ASSERT_TRUE(run.wait_until([&] { return read(saved) != before; }));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds(random)));
    run.send(SIGKILL);
    const outcome killed = run.wait();
    if (killed.code == 1000 + SIGKILL) ++kills;
    if (read(saved) != before) ++in_steps;
    ASSERT_EQ(killed.code, 1000 + SIGKILL) << killed.err;
    ASSERT_FALSE(fs::exists(folder.path() / "o/manifest.json"));
  }
  EXPECT_EQ(kills, 50);
  EXPECT_GE(in_steps, 25);
  const outcome last = run_apsis(folder, go_on("0"));
  ASSERT_EQ(last.code, 0) << last.err;
  expect_same_results(folder.path() / "whole", folder.path() / "o");
  for (const auto& name : names_in(folder.path() / "o")) EXPECT_NE(name.front(), '.') << name;
}

INSTANTIATE_TEST_SUITE_P(signals, interruption, testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(results, a_graded_start_continues_from_a_checkpoint_bit_for_bit_and_reports_its_cost) {
  const work_folder folder;
  // The steps are slow enough that the run can be stopped after the first step of the graded start.
  const std::vector<std::string> slow = {"run",
                                         "paper/bgk-mixed",
                                         "time.method=md-imex-4-2",
                                         "space.cells=300",
                                         "velocity.points=300",
                                         "model.epsilon=1e-16",
                                         "time.startup=graded",
                                         "time.end=0.0002"};
  ASSERT_EQ(run_apsis(folder, with(slow, {"--wall", "0.001", "--out", "stopped"})).code, 130);
  const json stopped = json::parse(read(folder.path() / "stopped/manifest.json"))["result"];
  ASSERT_LT(stopped["steps"].get<long>(), stopped["startup_steps"].get<long>());
  const outcome resumed =
      run_apsis(folder, with(slow, {"--restart", "stopped/checkpoint.h5", "--out", "resumed"}));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  const outcome whole = run_apsis(folder, with(slow, {"--out", "whole"}));
  ASSERT_EQ(whole.code, 0) << whole.err;
  expect_same_results(folder.path() / "whole", folder.path() / "resumed");
  const long steps =
      json::parse(read(folder.path() / "whole/manifest.json"))["result"]["startup_steps"].get<long>();
  EXPECT_GT(steps, 35);
  EXPECT_THAT(whole.out, HasSubstr(std::to_string(steps) + " steps instead of 1"));
  EXPECT_THAT(run_apsis(folder, {"run", "paper/ode", "model.epsilon=0", "time.startup=graded"}).out,
              HasSubstr("not needed"));
}

TEST(results, the_wall_time_ends_a_run_like_an_interrupt) {
  const work_folder folder;
  const outcome result = run_apsis(folder, with(small, {"time.end=50.0", "--wall", "0.3", "--out", "o"}));
  EXPECT_EQ(result.code, 130) << result.err;
  EXPECT_EQ(json::parse(read(folder.path() / "o/manifest.json"))["state"], "wall time reached");
  EXPECT_TRUE(fs::exists(folder.path() / "o/checkpoint.h5"));
}

TEST(results, a_checkpoint_of_another_case_or_a_damaged_one_is_refused) {
  const work_folder folder;
  ASSERT_EQ(run_apsis(folder, with(small, {"time.end=50.0", "--wall", "0.2", "--out", "o"})).code, 130);
  const outcome other = run_apsis(folder, {"run", "paper/bgk-mixed", "space.cells=24", "velocity.points=100",
                                           "--restart", "o/checkpoint.h5"});
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("'cells = 20' there, 'cells = 24' here"));
  const std::string whole = read(folder.path() / "o/checkpoint.h5");
  for (std::size_t part = 0; part < 20; ++part) {
    const auto size = whole.size() * part / 20;
    folder.file("cut.h5", whole.substr(0, size));
    const outcome cut = run_apsis(folder, with(small, {"--restart", "cut.h5", "--out", "p"}));
    EXPECT_EQ(cut.code, 4) << part << ": " << cut.err;
    EXPECT_FALSE(fs::exists(folder.path() / "p"));
  }
}

TEST(results, a_run_to_a_tolerance_continues_from_a_checkpoint_bit_for_bit_and_reports_rejections) {
  const work_folder folder;
  const auto run = with(small, {"time.method=md-imex-8-3", "time.tolerance=1e-5", "time.end=0.4"});
  // The first run ends at half the time, independently of the machine. Its checkpoint continues in a run with
  // a later end.
  ASSERT_EQ(run_apsis(folder, with(run, {"time.end=0.2", "--out", "stopped"})).code, 0);
  const outcome resumed =
      run_apsis(folder, with(run, {"--restart", "stopped/checkpoint.h5", "--out", "resumed"}));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  const outcome whole = run_apsis(folder, with(run, {"--out", "whole"}));
  ASSERT_EQ(whole.code, 0) << whole.err;
  expect_same_results(folder.path() / "whole", folder.path() / "resumed");
  const auto result = [&folder](const std::string& name) {
    return json::parse(read(folder.path() / name / "manifest.json"))["result"];
  };
  EXPECT_EQ(result("whole")["rejected_steps"], result("resumed")["rejected_steps"]);
  EXPECT_LT(result("stopped")["steps"].get<long>(), result("whole")["steps"].get<long>());
  const outcome rejecting =
      run_apsis(folder, {"run", "paper/ode", "time.method=md-imex-16-4-accurate", "model.epsilon=1e-3",
                         "time.dt=0.5", "time.tolerance=1e-8", "--json"});
  ASSERT_EQ(rejecting.code, 0) << rejecting.err;
  EXPECT_GE(json::parse(rejecting.out)["rejected_steps"].get<long>(), 1);
  EXPECT_THAT(whole.out, HasSubstr("steps rejected)"));
}

}  // namespace results_test
