// Fields along lines and on planes.
#include "cases_in_space.hpp"
#include "support/folder.hpp"

#include <apsis/config/case_json.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/output/column_file.hpp>
#include <apsis/output/hdf5_file.hpp>

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace probes_and_slices_test {

using namespace apsis;
using namespace in_several_dimensions;
using testing::ElementsAre;
namespace fs = std::filesystem;

using shape = hdf5_file::shape;

TEST(a_probe, is_written_at_every_snapshot_and_agrees_with_the_fields) {
  const test_folder folder;
  run_into(folder / "o", in_space + R"toml(
[[output.probe]]
name = "along-z"
from = [0.3125, 0.5, 0.0]
to = [0.3125, 0.5, 2.0]
points = 10
[[output.probe]]
from = [0, 0, 0]
to = [1, 1, 1]
)toml");
  const auto table = read_columns(folder / "o/probes/along-z.csv");
  ASSERT_EQ(table.columns.at("t").size(), 30U);
  EXPECT_EQ(table.columns.size(), 7U);  // t, s, x, y, z, rho, T
  const auto rho = hdf5_file::open(folder / "o/solution.h5").read("snapshots/rho");
  // The first two coordinates are the centre of cell (2, 3). Along z the points are on the sides of cells.
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t point = 1; point < 9; ++point) {
      const std::size_t cell = (2 * 7 + 3) * 9 + point;
      const double expected = 0.5 * (rho[k * 504 + cell - 1] + rho[k * 504 + cell]);
      EXPECT_NEAR(table.columns.at("rho")[10 * k + point], expected, 1e-14) << k << " " << point;
    }
  EXPECT_EQ(read_columns(folder / "o/probes/probe-2.csv").lines.size(), 303U);
}

TEST(a_slice, is_the_mean_of_two_layers_between_them) {
  const test_folder folder;
  run_into(folder / "o", in_space,
           {"output.slice.1.normal=y", "output.slice.1.at=2/7", "output.slice.1.name=low"});
  const auto whole = hdf5_file::open(folder / "o/solution.h5"),
             slice = hdf5_file::open(folder / "o/slices/low.h5");
  EXPECT_EQ(slice.extents("fields/rho"), (shape{8, 1, 9}));
  EXPECT_EQ(slice.extents("snapshots/T"), (shape{3, 8, 1, 9}));
  EXPECT_THAT(slice.read("y"), ElementsAre(2.0 / 7.0));
  EXPECT_EQ(slice.read("z"), whole.read("z"));
  const auto all = whole.read("fields/rho"), cut = slice.read("fields/rho");
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t l = 0; l < 9; ++l)
      EXPECT_NEAR(cut[i * 9 + l], 0.5 * (all[(i * 7 + 1) * 9 + l] + all[(i * 7 + 2) * 9 + l]), 1e-14);
  EXPECT_TRUE(fs::exists(folder / "o/slices/low.xdmf"));
}

TEST(probes_and_slices, of_an_earlier_run_are_removed) {
  const test_folder folder;
  const std::string probe = "output.probe.1.from=[0,0]";
  run_into(folder / "o", in_plane,
           {probe, "output.probe.1.to=[1,1]", "output.slice.1.normal=x", "output.slice.1.at=0.5"});
  EXPECT_TRUE(fs::exists(folder / "o/probes/probe-1.csv"));
  EXPECT_TRUE(fs::exists(folder / "o/slices/slice-1.h5"));
  run_into(folder / "o", in_plane);
  EXPECT_FALSE(fs::exists(folder / "o/probes"));
  EXPECT_FALSE(fs::exists(folder / "o/slices"));
}

TEST(probes_and_slices, are_read_back_from_their_case) {
  const std::string text = in_plane + R"toml(
[output]
distribution_at = [[0.5, 0.25], [1, -1]]
probe = [{from = [0, -1], to = [1, 1]}, {name = "b_2", from = [0.5, 0], to = [0.5, 1], points = 3}]
[[output.slice]]
normal = "y"
at = 0
)toml";
  const case_config once = parse_case(text, "case.toml"), twice = parse_case(to_toml(once), "again");
  EXPECT_EQ(to_toml(once), to_toml(twice));
  ASSERT_EQ(twice.output.probes.size(), 2U);
  EXPECT_EQ(twice.output.probes[0].name, "probe-1");
  EXPECT_EQ(twice.output.probes[0].points, 101);
  EXPECT_EQ(twice.output.probes[1].name, "b_2");
  EXPECT_THAT(twice.output.probes[1].to, ElementsAre(0.5, 1.0));
  EXPECT_EQ(twice.output.slices.at(0).direction, 1);
  EXPECT_THAT(twice.output.distribution_at, ElementsAre(ElementsAre(0.5, 0.25), ElementsAre(1.0, -1.0)));
  const auto json = to_json(once);
  EXPECT_EQ(json["output"]["probe"][1]["points"], 3);
  EXPECT_EQ(json["output"]["slice"][0]["normal"], "y");
}

TEST(probes_and_slices, are_in_the_units_of_the_results) {
  const test_folder folder;
  const std::string gas = R"toml(
[gas]
name = "argon"
pressure = "10 Pa"
temperature = "300 K"
length = "1 mm"
[model]
name = "bgk"
[initial]
rho = "1 + 0.1*x"
T = "300 K"
[space]
cells = [10, 8]
domain = [["0 mm", "2 mm"], ["0 mm", "1 mm"]]
boundary = "outflow"
[velocity]
max = 7
points = 12
[time]
method = "md-imex-3-2"
end = 0.0
dt = 0.001
[output]
distribution_at = [["0.5 mm", "0.55 mm"]]
[[output.probe]]
from = ["0.5 mm", "0.25 mm"]
to = ["1.5 mm", "0.75 mm"]
points = 3
[[output.slice]]
normal = "x"
at = "1 mm"
)toml";
  run_into(folder / "own", gas);
  run_into(folder / "si", gas, {"output.units=SI"});
  const auto own = read_columns(folder / "own/probes/probe-1.csv"),
             si = read_columns(folder / "si/probes/probe-1.csv");
  const double density = parse_case(gas, "case.toml").scales->unit(dimensions::density);
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = 0.5 + 0.5 * static_cast<double>(k);  // in mm, the unit of length of the case
    EXPECT_NEAR(own.columns.at("x")[k], x, 1e-15);
    EXPECT_NEAR(si.columns.at("x")[k], 1e-3 * x, 1e-18);
    EXPECT_NEAR(own.columns.at("rho")[k], 1.0 + 0.1 * x, 1e-12);
    EXPECT_NEAR(si.columns.at("rho")[k] / density, 1.0 + 0.1 * x, 1e-12);
  }
  const auto slice = hdf5_file::open(folder / "si/slices/slice-1.h5");
  EXPECT_THAT(slice.read("x"), ElementsAre(testing::DoubleEq(1e-3)));
  EXPECT_EQ(slice.units("x"), "m");
  const auto solution = hdf5_file::open(folder / "si/solution.h5");
  EXPECT_THAT(solution.read("points/y"), ElementsAre(testing::DoubleEq(4.5 / 8.0 * 1e-3)));
  EXPECT_EQ(solution.units("points/y"), "m");
}

TEST(probes_and_slices, of_a_continued_run_are_those_of_an_uninterrupted_one) {
  const test_folder folder;
  const std::string text = in_space + R"toml(
[[output.probe]]
from = [0.1, 0.2, 0.3]
to = [0.9, 0.8, 1.7]
[[output.slice]]
normal = "x"
at = 0.3
)toml";
  run_into(folder / "whole", text);
  run_into(folder / "first", text, {"time.end=0.001"});
  session_options how;
  how.out = folder / "second";
  how.restart = folder / "first/checkpoint.h5";
  run_session(parse_case(text, "case.toml"), how).run();
  const auto whole = read_columns(folder / "whole/probes/probe-1.csv"),
             second = read_columns(folder / "second/probes/probe-1.csv");
  EXPECT_EQ(whole.columns.at("t").size(), 303U);
  EXPECT_EQ(whole.columns, second.columns);
  const auto a = hdf5_file::open(folder / "whole/slices/slice-1.h5"),
             b = hdf5_file::open(folder / "second/slices/slice-1.h5");
  EXPECT_EQ(a.read("snapshots/rho"), b.read("snapshots/rho"));
  EXPECT_EQ(a.read("snapshots/t"), b.read("snapshots/t"));
}

}  // namespace probes_and_slices_test
