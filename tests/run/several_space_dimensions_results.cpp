// Results in two and three space dimensions: layout of the files, probes, slices, chosen cells and memory.
#include "support/folder.hpp"
#include "support/property.hpp"

#include <apsis/config/case_schema.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/output/case_json.hpp>
#include <apsis/output/column_file.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/output/probe.hpp>
#include <apsis/run/memory_need.hpp>
#include <apsis/run/session.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace apsis;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

using shape = hdf5_file::shape;
namespace fs = std::filesystem;

const std::string in_plane = R"toml(
[model]
name = "bgk"
epsilon = 0.01
[initial]
rho = "1 + 0.2*x + 0.3*y"
T = 1
u = ["0.1*sin(2*pi*x)*cos(2*pi*y)", "-0.1*cos(2*pi*x)*sin(2*pi*y)"]
[space]
cells = [7, 6]
domain = [[0.0, 1.0], [-1.0, 1.0]]
boundary = "outflow"
[velocity]
max = 7.0
points = 12
[time]
method = "md-imex-3-2"
end = 0.002
dt = 0.001
)toml";

const std::string in_space = R"toml(
[model]
name = "bgk"
epsilon = 0.01
[initial]
rho = "1 + 0.1*x + 0.02*y + 0.003*z"
T = 1
[space]
cells = [8, 7, 9]
domain = [[0.0, 1.0], [0.0, 1.0], [0.0, 2.0]]
boundary = "outflow"
[velocity]
max = 7.0
points = 8
equilibrium = "discrete"
[time]
method = "md-imex-3-2"
end = 0.002
dt = 0.001
[output]
fields = ["rho", "T"]
every = 0.001
)toml";

/// Runs a case into a folder.
void run_into(const std::string& folder, const std::string& text,
              const std::vector<std::string>& overrides = {}) {
  session_options how;
  how.out = folder;
  run_session session(parse_case(text, "case.toml", overrides), how);
  ASSERT_EQ(session.run(), run_end::complete);
}

std::string refusal(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    static_cast<void>(parse_case(text, "case.toml", overrides));
  } catch (const input_error& refused) {
    return refused.what();
  }
  return "accepted";
}

/// An affine function of the position on a mesh of 5 × 4 × 3 cells of the unit cube.
field_series affine(const std::vector<double>& slopes, bool periodic = false) {
  field_series fields;
  const std::vector<int> cells = {5, 4, 3};
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    mesh_axis axis{std::string(1, "xyz"[k]), {}, periodic};
    for (int i = 0; i < cells[k]; ++i) axis.centres.push_back((i + 0.5) / cells[k]);
    fields.axes.push_back(axis);
  }
  fields.names = fields.labels = {"phi"};
  std::vector<double> values;
  for (std::size_t cell = 0; cell < mesh_size(fields.axes); ++cell) {
    double value = 1.0;
    for (std::size_t k = 0; k < slopes.size(); ++k) value += slopes[k] * centre_of_cell(fields.axes, cell, k);
    values.push_back(value);
  }
  fields.snapshots = {{0.0, {values}}};
  return fields;
}

}  // namespace

TEST(results_in_space, have_the_shape_of_the_mesh_with_x_slowest) {
  for (const auto& [text, cells] : {std::pair{in_plane + "[output]\nevery = 0.001\n", shape{7, 6}},
                                    std::pair{in_space, shape{8, 7, 9}}}) {
    const test_folder folder;
    run_into(folder / "o", text);
    const auto file = hdf5_file::open(folder / "o/solution.h5");
    const std::size_t d = cells.size();
    const std::uint64_t components = d == 2 ? 144 : 512;
    shape with_components = cells, with_snapshots = cells, with_coordinates = cells;
    with_components.push_back(components);
    with_coordinates.push_back(3);
    with_snapshots.insert(with_snapshots.begin(), 3);
    EXPECT_EQ(file.extents("f"), with_components);
    EXPECT_EQ(file.extents("epsilon"), cells);
    EXPECT_EQ(file.extents("fields/rho"), cells);
    EXPECT_EQ(file.extents("snapshots/T"), with_snapshots);
    EXPECT_EQ(file.extents("geometry/centres"), with_coordinates);
    // The first snapshot is the initial density, an affine function of x, y and z.
    const std::vector<double> slopes = d == 2 ? std::vector{0.2, 0.3} : std::vector{0.1, 0.02, 0.003};
    std::vector<mesh_axis> axes;
    for (std::size_t k = 0; k < d; ++k) {
      const std::string name(1, "xyz"[k]);
      axes.push_back({name, file.read(name)});
      ASSERT_EQ(axes[k].centres.size(), cells[k]);
    }
    const auto rho = file.read("snapshots/rho"), points = file.read("geometry/centres");
    const auto table = read_columns(folder / "o/fields.csv");
    for (std::size_t cell = 0; cell < mesh_size(axes); ++cell) {
      double expected = 1.0;
      for (std::size_t k = 0; k < d; ++k) {
        const double x = centre_of_cell(axes, cell, k);
        expected += slopes[k] * x;
        EXPECT_EQ(points[3 * cell + k], x);
        EXPECT_EQ(table.columns.at(axes[k].name)[cell], x);
      }
      // Sums over velocities lose a few roundings of 2e-16.
      EXPECT_NEAR(rho[cell], expected, 1e-13) << cell;
      EXPECT_EQ(table.columns.at("rho")[cell], rho[cell]);
      EXPECT_EQ(points[3 * cell + 2], d == 2 ? 0.0 : centre_of_cell(axes, cell, d - 1));
    }
  }
}

TEST(results_in_space, of_the_command_line_are_nested_lists) {
  session_options how;
  run_session session(parse_case(in_plane, "case.toml"), how);
  session.run();
  const auto json = to_json(session.computed(), session.records());
  const auto& rho = json["fields"]["rho"];
  ASSERT_EQ(rho.size(), 7U);
  ASSERT_EQ(rho[0].size(), 6U);
  const field_table fields = session.computed().fields();
  EXPECT_THAT(fields.shape, ElementsAre(7, 6));
  EXPECT_TRUE(fields.z.empty());
  for (std::size_t i = 0; i < 7; ++i)
    for (std::size_t j = 0; j < 6; ++j) {
      EXPECT_EQ(rho[i][j], fields.values[0][6 * i + j]);
      EXPECT_EQ(json["fields"]["x"][i], fields.x[6 * i + j]);
      EXPECT_EQ(json["fields"]["y"][j], fields.y[6 * i + j]);
    }
}

TEST(a_probe, is_exact_for_affine_functions_also_in_the_outer_half_of_cells_at_the_ends) {
  check_property("affine functions", [] {
    const auto d = *rc::gen::inRange<std::size_t>(1, 4);
    const auto number = [] { return 0.001 * *rc::gen::inRange(0, 1001); };
    std::vector<double> slopes;
    line_probe line{"p", {}, {}, 7};
    for (std::size_t k = 0; k < d; ++k) {
      slopes.push_back(number() - 0.5);
      line.from.push_back(number());
      line.to.push_back(number());
    }
    const numeric_table table = to_table(affine(slopes), line);
    RC_ASSERT(table.rows.size() == 7U);
    for (std::size_t row = 0; row < 7; ++row) {
      double expected = 1.0, square = 0.0;
      for (std::size_t k = 0; k < d; ++k) {
        const double x = line.from[k] + (line.to[k] - line.from[k]) * static_cast<double>(row) / 6.0;
        RC_ASSERT(std::abs(table.rows[row][1 + k] - x) < 1e-15);
        expected += slopes[k] * x;
        square += (x - line.from[k]) * (x - line.from[k]);
      }
      // Differences of numbers near 1, extrapolated over half a cell.
      RC_ASSERT(std::abs(table.rows[row].back() - expected) < 1e-13);
      RC_ASSERT(std::abs(table.rows[row][0] - std::sqrt(square)) < 1e-15);
    }
    for (std::size_t k = 0; k < d; ++k) RC_ASSERT(table.rows.back()[1 + k] == line.to[k]);
  });
}

TEST(a_probe, continues_across_a_periodic_end) {
  // Between the last cell, centre 0.9, and the first one at 1.1: 1 + 0.9 s and 1 + 0.1 s have the mean 1.5 at
  // x = 1 and at x = 0.
  const field_series fields = affine({1.0}, true);
  const auto table = to_table(fields, line_probe{"p", {0.0}, {1.0}, 11});
  EXPECT_NEAR(table.rows.front().back(), 1.5, 1e-14);
  EXPECT_NEAR(table.rows.back().back(), 1.5, 1e-14);
  EXPECT_NEAR(table.rows[5].back(), 1.5, 1e-14);
}

TEST(a_probe, beside_cells_without_values_has_those_of_the_nearer_cells) {
  field_series fields = affine({0.0, 0.0});
  auto& values = fields.snapshots[0].values[0];
  for (std::size_t j = 0; j < 4; ++j) values[2 * 4 + j] = std::numeric_limits<double>::quiet_NaN();
  const auto table = to_table(fields, line_probe{"p", {0.0, 0.3}, {1.0, 0.3}, 101});
  for (const auto& row : table.rows) {
    const double x = row[1];
    if (std::abs(x - 0.4) < 1e-9 || std::abs(x - 0.6) < 1e-9) continue;  // on the side of a cell
    EXPECT_EQ(std::isnan(row.back()), x > 0.4 && x < 0.6) << x;
    if (std::isnan(row.back())) continue;
    EXPECT_NEAR(row.back(), 1.0, 1e-15);
  }
}

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
  // The first two coordinates are the centre of cell (2, 3); along z the points are on the sides of cells.
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

TEST(probes_and_slices, that_are_not_possible_are_refused_with_their_key) {
  const std::string probe = in_plane + "[[output.probe]]\nfrom = [0, 0]\nto = [1, 1]\n";
  EXPECT_EQ(refusal(probe), "accepted");
  EXPECT_THAT(refusal(probe, {"output.probe.1.to=[1, 1.5]"}),
              HasSubstr("'output.probe.1.to' is outside the domain (y = 1.5 is not in [-1, 1])"));
  EXPECT_THAT(refusal(probe, {"output.probe.1.to=[1, 1, 1]"}), HasSubstr("a point has 2 coordinates here"));
  EXPECT_THAT(refusal(probe, {"output.probe.1.to=[nan, 1]"}), HasSubstr("it must be finite"));
  EXPECT_THAT(refusal(probe, {"output.probe.1.to=[0, 0]"}), HasSubstr("the same point as 'from'"));
  EXPECT_THAT(refusal(probe, {"output.probe.1.points=1"}), HasSubstr("at least 2 and at most 1000000"));
  EXPECT_THAT(refusal(probe, {"output.probe.1.name=../x"}), HasSubstr("the name of a file is needed"));
  EXPECT_THAT(refusal(probe, {"output.probe.1.form=[0, 0]"}), HasSubstr("did you mean 'from'"));
  EXPECT_THAT(refusal(probe, {"output.probe.2.from=[0, 0]"}),
              HasSubstr("key 'output.probe.2.to' is missing"));
  EXPECT_THAT(refusal(probe, {"output.probe.x.from=[0, 0]"}), HasSubstr("numbered from 1 to at most 1000"));
  EXPECT_THAT(refusal(probe + "name = \"a\"\n[[output.probe]]\nname = \"a\"\nfrom = [0, 0]\nto = [1, 1]\n"),
              HasSubstr("two tables [[output.probe]] have the name 'a'"));
  EXPECT_THAT(refusal(in_plane + "[output]\nprobe = 5\n"), HasSubstr("write [[output.probe]]"));
  EXPECT_THAT(refusal(in_plane, {"output.slice.1.normal=z", "output.slice.1.at=0"}),
              HasSubstr("it must be one of x, y"));
  EXPECT_THAT(refusal(in_plane, {"output.slice.1.normal=x", "output.slice.1.at=2"}),
              HasSubstr("'output.slice.1.at' is outside the domain (x = 2 is not in [0, 1])"));
  EXPECT_THAT(refusal(in_plane, {"output.distribution_at=[[0.5, 3]]"}), HasSubstr("outside the domain"));
  EXPECT_THAT(refusal(in_plane, {"output.distribution_at=[0.5, 0.5]"}), HasSubstr("a list of points"));
  EXPECT_THAT(refusal(in_plane, {"output.distribution_at=[[0.5, 0]]", "output.stride=2"}),
              HasSubstr("conflicts with output.stride"));
  EXPECT_THAT(refusal(in_plane, {"output.distribution_at=[[0.5, 0]]", "output.distribution=none"}),
              HasSubstr("conflicts with output.distribution"));
}

TEST(f_at_chosen_points, is_that_of_the_cells_that_contain_them) {
  const test_folder folder;
  const std::vector<std::string> snapshots = {"output.every=0.001", "output.distribution=snapshots"};
  std::vector<std::string> chosen = snapshots;
  chosen.emplace_back("output.distribution_at=[[0.5, 0.25], [1, 1], [0, -1]]");
  run_into(folder / "all", in_plane, snapshots);
  run_into(folder / "some", in_plane, chosen);
  for (const std::string name : {"solution.h5", "snapshots/f-000000001.h5"}) {
    const auto all = hdf5_file::open(folder / ("all/" + name)),
               some = hdf5_file::open(folder / ("some/" + name));
    EXPECT_FALSE(some.has("f"));
    ASSERT_EQ(some.extents("points/f"), (shape{3, 144}));
    const auto f = all.read("f"), rows = some.read("points/f"), x = all.read("x"), y = all.read("y");
    // Of the cells of width 1/7 and 1/3: (3, 3), and those in two corners.
    const std::vector<std::array<std::size_t, 2>> cells = {{3, 3}, {6, 5}, {0, 0}};
    for (std::size_t point = 0; point < 3; ++point) {
      const auto [i, j] = cells[point];
      EXPECT_EQ(some.read("points/x")[point], x[i]);
      EXPECT_EQ(some.read("points/y")[point], y[j]);
      for (std::size_t k = 0; k < 144; ++k) ASSERT_EQ(rows[144 * point + k], f[(6 * i + j) * 144 + k]);
    }
  }
}

TEST(f_of_every_second_cell, is_a_mesh_with_half_the_cells_in_each_direction) {
  const test_folder folder;
  const std::vector<std::string> snapshots = {"output.every=0.002", "output.distribution=snapshots"};
  std::vector<std::string> thin = snapshots;
  thin.emplace_back("output.stride=2");
  run_into(folder / "all", in_plane, snapshots);
  run_into(folder / "some", in_plane, thin);
  const std::string name = "/snapshots/f-000000002.h5";
  const auto all = hdf5_file::open(folder / ("all" + name)), some = hdf5_file::open(folder / ("some" + name));
  ASSERT_EQ(some.extents("f"), (shape{4, 3, 144}));
  EXPECT_EQ(some.extents("marginals/v_x"), (shape{4, 3, 12}));
  const auto f = all.read("f"), rows = some.read("f"), y = all.read("y");
  EXPECT_THAT(some.read("y"), ElementsAre(y[0], y[2], y[4]));
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 144; ++k)
        ASSERT_EQ(rows[(3 * i + j) * 144 + k], f[(12 * i + 2 * j) * 144 + k]);
}

TEST(memory_need, of_a_run_that_does_not_fit_is_refused_with_the_sizes_that_would) {
  const auto bytes = [](const std::vector<std::string>& overrides) {
    const case_config c = parse_case(in_plane, "case.toml", overrides);
    return memory_need(c, run_setup(c), 2).bytes();
  };
  const case_config c = parse_case(in_plane, "case.toml", {"space.cells=[70, 60]"});
  const memory_need need(c, run_setup(c), 2);
  EXPECT_EQ(need.bytes(), bytes({"space.cells=[70, 60]"}));
  EXPECT_EQ(need.bytes(), 100.0 * bytes({}));
  EXPECT_THAT(need.text(), HasSubstr("70 x 60 cells x 144 unknowns"));
  for (const double share : {0.9, 0.5, 0.2}) {
    const double limit = share * need.bytes();
    const auto cells = need.cells_that_fit(limit), points = need.points_that_fit(limit);
    ASSERT_EQ(cells.size(), 2U);
    ASSERT_EQ(points.size(), 1U);
    const auto with_cells = [&](int more) {
      return bytes(
          {"space.cells=[" + std::to_string(cells[0] + more) + "," + std::to_string(cells[1] + more) + "]"});
    };
    const auto with_points = [&](int more) {
      return bytes({"space.cells=[70, 60]", "velocity.points=" + std::to_string(points[0] + more)});
    };
    EXPECT_LE(with_cells(0), limit);
    EXPECT_GT(with_cells(1), limit);
    EXPECT_LE(with_points(0), limit);
    EXPECT_GT(with_points(1), limit);
  }
  EXPECT_TRUE(need.cells_that_fit(0.0).empty());
  EXPECT_TRUE(need.points_that_fit(1.0).empty());
  try {
    const case_config large =
        parse_case(in_plane, "case.toml", {"space.cells=[3000, 3000]", "velocity.points=200"});
    check_memory(large, run_setup(large), 0);
    FAIL() << "accepted";
  } catch (const input_error& refused) {
    EXPECT_THAT(refused.what(), testing::AllOf(HasSubstr("space.cells = ["), HasSubstr("would fit")));
  }
}

TEST(results_in_space, are_initial_data_of_another_run_on_the_same_mesh) {
  const test_folder folder;
  run_into(folder / "o", in_plane + "[output]\nevery = 0.001\ndistribution = \"snapshots\"\n");
  const std::string from = "initial.file=" + (folder / "o/solution.h5");
  const auto state_at_start = [](const case_config& c) { return simulation(c).state(); };
  // The unknowns bit for bit, at the end and at an earlier time.
  const auto end = hdf5_file::open(folder / "o/solution.h5").read("f");
  EXPECT_EQ(state_at_start(parse_case(in_plane, "case.toml", {from})), end);
  EXPECT_EQ(state_at_start(parse_case(in_plane, "case.toml", {from, "initial.time=0.001"})),
            hdf5_file::open(folder / "o/snapshots/f-000000001.h5").read("f"));
  // Equilibria with the fields of a table; a region above them.
  const std::string table = "initial.file=" + (folder / "o/fields.csv");
  const auto fields = simulation(parse_case(in_plane, "case.toml", {table})).fields();
  const auto rho = hdf5_file::open(folder / "o/solution.h5").read("fields/rho");
  for (std::size_t cell = 0; cell < 42; ++cell) EXPECT_NEAR(fields.values[0][cell], rho[cell], 1e-12);
  const auto above =
      simulation(parse_case(in_plane, "case.toml",
                            {from, "initial.region.1.where=x < 0.5 && y > 0", "initial.region.1.rho=2",
                             "initial.region.1.u=0", "initial.region.1.T=1"}))
          .fields();
  for (std::size_t cell = 0; cell < 42; ++cell)
    EXPECT_NEAR(above.values[0][cell], above.x[cell] < 0.5 && above.y[cell] > 0.0 ? 2.0 : rho[cell], 1e-12);
  const auto refused = [&](const std::vector<std::string>& overrides) -> std::string {
    try {
      simulation(parse_case(in_plane, "case.toml", overrides));
    } catch (const input_error& refusal) {
      return refusal.what();
    }
    return "accepted";
  };
  EXPECT_THAT(refused({from, "space.cells=[8, 6]"}), HasSubstr("it has 42 cells and the case 48"));
  EXPECT_THAT(refused({from, "space.cells=[6, 7]"}), HasSubstr("use its space.cells and space.domain"));
  EXPECT_THAT(refused({from, "space.domain=[[0, 2], [-1, 1]]"}), HasSubstr("x = "));
}
