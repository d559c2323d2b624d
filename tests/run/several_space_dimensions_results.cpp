// Results in two and three space dimensions: layout of the files, chosen cells, initial data and memory.
#include "cases_in_space.hpp"
#include "support/folder.hpp"
#include "xdmf_grids.hpp"

#include <apsis/output/column_file.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/output/mesh_axis.hpp>
#include <apsis/run/memory_need.hpp>

#include <array>
#include <cmath>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <support/bad_input.hpp>

namespace several_space_dimensions_results_test {

using namespace apsis;
using namespace in_several_dimensions;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

using shape = hdf5_file::shape;

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
    // The first snapshot is the initial density, which is affine in x, y and z.
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
      // Sums over velocities have a few rounding errors of 2e-16.
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
    // The points lie in cells of width 1/7 and 1/3: in cell (3, 3) and in those at two corners.
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
    return memory_need(run_setup(c), 2).bytes();
  };
  const case_config c = parse_case(in_plane, "case.toml", {"space.cells=[70, 60]"});
  const memory_need need(run_setup(c), 2);
  EXPECT_EQ(need.bytes(), bytes({"space.cells=[70, 60]"}));
  // There are a hundred times as many cells, and ten times as many rows at their ends. The latter are less
  // than a tenth of all here.
  EXPECT_LT(need.bytes(), 100.0 * bytes({}));
  EXPECT_GT(need.bytes(), 90.0 * bytes({}));
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
  bad_input::expect_refused({{[&] {
                                const case_config large =
                                    parse_case(in_plane, "case.toml",
                                               {"space.cells=[3000, 3000]", "velocity.points=200"});
                                check_memory(run_setup(large), 0);
                              },
                              {"space.cells = [", "would fit"}}});
}

TEST(results_in_space, are_initial_data_of_another_run_on_the_same_mesh) {
  const test_folder folder;
  run_into(folder / "o", in_plane + "[output]\nevery = 0.001\ndistribution = \"snapshots\"\n");
  const std::string from = "initial.file=" + (folder / "o/solution.h5");
  const auto state_at_start = [](const case_config& c) { return simulation(c).state(); };
  // The data are the unknowns bit for bit, at the end and at an earlier time.
  const auto end = hdf5_file::open(folder / "o/solution.h5").read("f");
  EXPECT_EQ(state_at_start(parse_case(in_plane, "case.toml", {from})), end);
  EXPECT_EQ(state_at_start(parse_case(in_plane, "case.toml", {from, "initial.time=0.001"})),
            hdf5_file::open(folder / "o/snapshots/f-000000001.h5").read("f"));
  // From a table the data are equilibria with its fields. A region replaces some of them.
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
  const auto set_up = [&](const std::vector<std::string>& overrides) {
    simulation(parse_case(in_plane, "case.toml", overrides));
  };
  bad_input::expect_refused({
      {[&] { set_up({from, "space.cells=[8, 6]"}); }, {"it has 42 cells and the case 48"}},
      {[&] { set_up({from, "space.cells=[6, 7]"}); }, {"use its space.cells and space.domain"}},
      {[&] { set_up({from, "space.domain=[[0, 2], [-1, 1]]"}); }, {"x = "}},
  });
}

TEST(results_in_space, around_a_solid_box_have_no_values_inside_and_start_another_run) {
  const test_folder folder;
  const std::vector<std::string> box = {"space.cells=[8, 6]", "space.solid.1.from=[0.25, -1]",
                                        "space.solid.1.to=[0.5, 0]", "space.solid.1.T=1"};
  std::vector<std::string> with_probe = box;
  with_probe.emplace_back("output.probe.1.from=[0, -0.5]");
  with_probe.emplace_back("output.probe.1.to=[1, -0.5]");
  run_into(folder / "o", in_plane, with_probe);
  const auto rho = hdf5_file::open(folder / "o/solution.h5").read("fields/rho");
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t j = 0; j < 6; ++j)
      EXPECT_EQ(std::isnan(rho[6 * i + j]), (i == 2 || i == 3) && j < 3) << i << " " << j;
  const std::string probe = text_of(folder / "o/probes/probe-1.csv");
  EXPECT_THAT(probe, HasSubstr("nan"));
  std::vector<std::string> from = box;
  from.push_back("initial.file=" + (folder / "o/solution.h5"));
  const auto again = simulation(parse_case(in_plane, "case.toml", from)).fields();
  for (std::size_t cell = 0; cell < 48; ++cell) {
    EXPECT_EQ(std::isnan(again.values[0][cell]), std::isnan(rho[cell]));
    if (!std::isnan(rho[cell])) {
      EXPECT_EQ(again.values[0][cell], rho[cell]);
    }
  }
}

}  // namespace several_space_dimensions_results_test
