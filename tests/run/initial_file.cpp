// Initial data from files: a result and its continuation share all bits, totals under refinement and
// coarsening, observed orders, units, and files that cannot be used.
#include <apsis/config/case.hpp>
#include <apsis/config/case_schema.hpp>
#include <apsis/core/text_file.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/run/session.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/scheme/cell_polynomials.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <support/bad_input.hpp>
#include <support/folder.hpp>

namespace initial_file_test {

namespace {

using apsis::case_config;
using apsis::field;
using apsis::hdf5_file;
using apsis::input_error;
using apsis::parse_case;
using apsis::run_setup;
using testing::HasSubstr;

const std::string sod =
    "[initial]\nrho = 1\nT = 1\n[[initial.region]]\nwhere = \"x > 0.5\"\nrho = 0.125\nT = 0.8\n";

/// Returns a case of a gas in which line 4 begins the table [initial].
std::string gas(const std::string& initial, const std::string& model = "name = \"bgk\"\nepsilon = 0.01") {
  return "[model]\n" + model + "\n" + initial +
         "[space]\ncells = 20\ndomain = [0.0, 1.0]\nboundary = \"outflow\"\nlimiter = \"positivity\"\n"
         "[velocity]\nmax = 8\npoints = 32\n[time]\nmethod = \"md-imex-3-2\"\nend = 0.02\nsafety = 1.0\n";
}

std::string from(const std::string& file) {
  return fmt::format("[initial]\nfile = \"{}\"\n", file);
}

/// Runs a case into a folder of the test, and returns the folder.
std::string run(const std::string& text, const std::string& folder,
                const std::vector<std::string>& overrides = {}) {
  apsis::session_options options;
  options.out = folder;
  apsis::run_session(parse_case(text, "c.toml", overrides), options).run();
  return folder;
}

field state_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return run_setup(parse_case(text, "c.toml", overrides)).initial_state();
}

std::vector<double> numbers_of(const field& u) {
  std::vector<double> all;
  for (int cell = 0; cell < u.cells(); ++cell)
    all.insert(all.end(), u.row(cell), u.row(cell) + u.components());
  return all;
}

/// Returns mass, momentum and energy on [0, 1] by the moments of the model.
std::vector<double> totals(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const run_setup setup(parse_case(text, "c.toml", overrides));
  const field u = setup.initial_state();
  const std::size_t count = setup.equation->invariants().size();
  std::vector<double> sums(count), densities(count);
  for (int cell = 0; cell < u.cells(); ++cell) {
    setup.equation->invariant_densities(u.row(cell), densities.data());
    for (std::size_t k = 0; k < count; ++k) sums[k] += densities[k] / u.cells();
  }
  return sums;
}

void set_up(const std::string& text, const std::vector<std::string>& overrides = {}) {
  state_of(text, overrides);
}

std::string table(const std::string& name, const std::string& text) {
  apsis::write_text_file(name, text);
  return name;
}

}  // namespace

TEST(initial_file, of_a_result_on_its_own_mesh_is_its_final_state_bit_for_bit) {
  const test_folder files;
  for (const char* formulation : {"finite-volume", "finite-difference"}) {
    const std::string how = fmt::format("space.formulation={}", formulation);
    const std::string folder = run(gas(sod), files / formulation, {how});
    const auto f = hdf5_file::open(folder + "/solution.h5").read("f");
    EXPECT_EQ(numbers_of(state_of(gas(from(folder + "/solution.h5")), {how})), f) << formulation;
  }
}

TEST(initial_file, keeps_mass_momentum_and_energy_to_rounding_on_finer_and_coarser_meshes) {
  const test_folder files;
  const std::string folder = run(gas(sod), files / "r");
  const auto before = totals(gas(from(folder + "/solution.h5")));
  for (const char* file : {"/solution.h5", "/fields.csv"})  // the state, and equilibria with the fields
    for (const int cells : {7, 13, 20, 31}) {
      const auto after = totals(gas(from(folder + file)), {fmt::format("space.cells={}", cells)});
      // The totals are sums of 20 cells times 32 velocities. The numbers are rounded at each of up to 20
      // points of a cell.
      for (std::size_t k = 0; k < before.size(); ++k)
        EXPECT_NEAR(after[k], before[k], 2e-14) << file << ", " << cells << " cells, invariant " << k;
    }
}

TEST(initial_file, of_a_result_has_no_negative_values_on_any_mesh) {
  const test_folder files;
  const std::string file = run(gas(sod), files / "r", {"model.epsilon=1e-8"}) + "/solution.h5";
  for (const char* formulation : {"finite-volume", "finite-difference"})
    for (const int cells : {11, 20, 33, 90}) {
      const auto f =
          numbers_of(state_of(gas(from(file)), {fmt::format("space.cells={}", cells),
                                                fmt::format("space.formulation={}", formulation)}));
      EXPECT_GE(*std::min_element(f.begin(), f.end()), 0.0) << formulation << ", " << cells << " cells";
    }
}

/// Returns the distance per cell between the state from a file and that from formulas.
double distance(const std::string& file, const std::string& formulas,
                const std::vector<std::string>& overrides) {
  const auto a = numbers_of(state_of(gas(from(file)), overrides)),
             b = numbers_of(state_of(gas(formulas), overrides));
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += std::abs(a[k] - b[k]);
  return sum / static_cast<double>(a.size());
}

TEST(initial_file, has_third_order_between_averages_and_point_values) {
  const test_folder files;
  // Where the problem is not periodic, the extremum inside and the ends count.
  const std::string smooth =
      "[initial]\nrho = \"1 + 0.3*sin(3*x)\"\nu = \"0.2*cos(2*x)\"\nT = \"1 + 0.1*x\"\n";
  const std::string volume = "space.formulation=finite-volume",
                    points = "space.formulation=finite-difference";
  for (const auto& source : {volume, points})
    for (const auto& target : {volume, points})
      for (const char* kind : {"/solution.h5", "/fields.csv"}) {
        std::array<double, 2> errors{};
        for (std::size_t k = 0; k < 2; ++k) {
          const int cells = k == 0 ? 20 : 40;
          const std::string folder =
              run(gas(smooth),
                  files / fmt::format("{}-{}-{}{}", cells, source == volume, target == volume, kind[1]),
                  {source, "time.end=0", fmt::format("space.cells={}", cells)});
          errors[k] = distance(folder + kind, smooth, {target, fmt::format("space.cells={}", 3 * cells)});
        }
        const double order = std::log2(errors[0] / errors[1]);
        EXPECT_GT(order, 2.8) << source << " to " << target << kind << ": " << errors[1];
        EXPECT_LT(errors[1], 1e-5) << source << " to " << target << kind;
      }
}

TEST(initial_file, with_a_snapshot_time_is_the_state_of_that_time) {
  const test_folder files;
  const std::vector<std::string> every = {"output.every=0.01", "output.distribution=snapshots"};
  const std::string folder = run(gas(sod), files / "r", every);
  std::vector<double> f;
  for (const auto& entry : std::filesystem::directory_iterator(folder + "/snapshots")) {
    const hdf5_file snapshot = hdf5_file::open(entry.path().string());
    if (std::abs(snapshot.read_attribute("t") - 0.01) < 1e-6) f = snapshot.read("f");
  }
  EXPECT_EQ(numbers_of(state_of(gas(from(folder + "/solution.h5")), {"initial.time=0.01"})), f);
  EXPECT_EQ(numbers_of(state_of(gas(from(folder + "/solution.h5")), {"initial.time=0.02"})),
            hdf5_file::open(folder + "/solution.h5").read("f"));
  // Without the distribution the data are equilibria with the fields of that time. Their totals are the same.
  const auto expected = totals(gas(from(folder + "/solution.h5")), {"initial.time=0.01"});
  for (const char* file : {"/solution.h5", "/fields.csv"}) {
    const std::string fields = run(gas(sod), files / "fields", {"output.every=0.01"});
    const auto found = totals(gas(from(fields + file)), {"initial.time=0.01"});
    for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_NEAR(found[k], expected[k], 2e-14) << file;
  }
  bad_input::expect_refused({
      {[&] { set_up(gas(from(folder + "/solution.h5")), {"initial.time=0.013"}); },
       {"it has no snapshot at initial.time = 0.013 (its times are 0, 0.01, 0.02); give one of these"}},
  });
}

TEST(initial_file, on_other_velocities_gives_equilibria_with_its_moments) {
  const test_folder files;
  const std::string space = "epsilon = 0.01\ndegrees_of_freedom = 3", bgk = "name = \"bgk\"\n" + space,
                    shakhov = "name = \"shakhov\"\n" + space;
  const std::string file = run(gas(sod, bgk), files / "r") + "/solution.h5";
  const auto before = totals(gas(from(file), bgk));
  for (const auto& model : {bgk, shakhov}) {
    const auto after = totals(gas(from(file), model), {"velocity.points=40"});
    // The energy follows from T and back. The tolerance also covers the rounding of sums of 20 cells.
    for (std::size_t k = 0; k < before.size(); ++k) EXPECT_NEAR(after[k], before[k], 3e-14) << model;
  }
  // Two gas models with the same degrees of freedom have the same distribution.
  EXPECT_EQ(numbers_of(state_of(gas(from(file), shakhov))), hdf5_file::open(file).read("f"));
}

TEST(initial_file, of_a_result_may_reach_further_than_data_on_its_velocities) {
  const test_folder files;
  // Beams mix without collisions to T = 2.4. Velocities up to 3.6 miss 0.15 of this Maxwellian.
  const std::string free = "name = \"bgk\"\nepsilon = 1e3";
  const std::string beams =
      "[initial]\nrho = 1\nT = 1\nu = 1.2\n[[initial.region]]\nwhere = \"x > 0.5\"\nu = -1.2\n";
  const std::vector<std::string> narrow = {"velocity.max=3.6", "time.end=0.1"};
  const std::string folder = run(gas(beams, free), files / "r", narrow);
  EXPECT_EQ(numbers_of(state_of(gas(from(folder + "/solution.h5"), free), narrow)),
            hdf5_file::open(folder + "/solution.h5").read("f"));
  bad_input::expect_refused({
      {[&] { set_up(gas(from(folder + "/fields.csv"), free), narrow); },
       {"velocity.max = 3.6 is too small for the data"}},
  });
}

TEST(initial_file, below_regions_is_replaced_where_they_are) {
  const test_folder files;
  const std::string file = run(gas(sod), files / "r") + "/solution.h5";
  const std::string text = gas(from(file) + "[[initial.region]]\nwhere = \"x < 0.33\"\nrho = 2\nT = 0.5\n");
  const run_setup setup(parse_case(text, "c.toml"));
  const field u = setup.initial_state(), old = state_of(gas(from(file)));
  double fields[5];
  setup.equation->macroscopic(u.row(3), fields);
  EXPECT_NEAR(fields[0], 2.0, 1e-13);
  EXPECT_NEAR(fields[2], 0.5, 1e-13);
  for (int k = 0; k < u.components(); ++k)
    EXPECT_NEAR(u.row(12)[k], old.row(12)[k], 1e-14) << k;  // averaged again, with rounding
  bad_input::expect_refused({
      {[&] { set_up(gas(from(file) + "[[initial.region]]\nwhere = \"x < 0.3\"\nT = 2\n")); },
       {"key 'initial.region.1.rho' is missing"}},
  });
}

TEST(initial_file, is_not_needed_by_a_restart) {
  const test_folder files;
  const std::string first = run(gas(sod), files / "r");
  const std::string text = gas(from(first + "/solution.h5"));
  const std::string whole = run(text, files / "whole", {"time.end=0.04"});
  const std::string half = run(text, files / "half");
  std::filesystem::remove_all(first);
  apsis::session_options options;
  options.restart = half + "/checkpoint.h5";
  apsis::run_session session(parse_case(text, "c.toml", {"time.end=0.04"}), options);
  session.run();
  EXPECT_EQ(session.computed().state(), hdf5_file::open(whole + "/solution.h5").read("f"));
  bad_input::expect_refused({
      {[&] { set_up(text); }, {"it does not exist"}},
  });
}

TEST(initial_file, in_si_units_is_read_in_those_of_the_case) {
  const test_folder files;
  const std::string argon =
      "[gas]\nname = \"argon\"\npressure = \"2 kPa\"\ntemperature = \"300 K\"\nlength = \"10 um\"\n";
  const auto of = [](const std::string& gas_table, const std::string& initial) {
    std::string text = gas(initial, "name = \"shakhov\"") + "[output]\nunits = \"SI\"\n";
    return gas_table + text;
  };
  const std::string warm = "[initial]\nrho = \"1 + 0.1*x\"\nT = \"1.2 - 0.1*x\"\n";
  const std::string folder = run(of(argon, warm), files / "si", {"time.end=0"});
  // With a reference pressure half as high, the density is twice as large in its units.
  std::string thinner = argon;
  thinner.replace(thinner.find("2 kPa"), 5, "1 kPa");
  for (const char* file : {"/solution.h5", "/fields.csv"}) {
    const run_setup same(parse_case(of(argon, from(folder + file)), "c.toml")),
        other(parse_case(of(thinner, from(folder + file)), "c.toml"));
    double a[5], b[5];
    same.equation->macroscopic(same.initial_state().row(7), a);
    other.equation->macroscopic(other.initial_state().row(7), b);
    EXPECT_NEAR(a[0], 1.0 + 0.1 * 7.5 / 20, 1e-13) << file;
    EXPECT_NEAR(b[0], 2.0 * a[0], 1e-13) << file;
    EXPECT_NEAR(b[2], a[2], 1e-13) << file;
    bad_input::expect_refused({
        {[&] { set_up(gas(from(folder + file), "name = \"shakhov\"\nepsilon = 1"), {"velocity.points=40"}); },
         {"(the case has no table [gas] with the scales of its quantities); add the table"}},
    });
  }
  const std::string numbers =
      run(of(argon, warm), files / "none", {"time.end=0", "output.units=dimensionless"});
  bad_input::expect_refused({
      {[&] { set_up(of(thinner, from(numbers + "/solution.h5"))); },
       {"its units are those of another table [gas] (the scales differ); write it with output.units = "
        "\"SI\""}},
  });
}

TEST(initial_file, of_a_table_has_the_averages_of_its_rows) {
  const test_folder files;
  // The file has few digits, a byte order mark, quotes, blank lines and columns that the model does not have.
  const std::string file = table(files / "own.csv",
                                 "\xEF\xBB\xBF\"x\", rho ,u_x,T,note\n# measured\n0.167,1,0.1,1,7\n\n"
                                 "0.5,+2,0.1,1.5,7\r\n0.833,1e0,0.1,1,7\n");
  for (const int cells : {9, 30}) {
    const auto found = totals(gas(from(file)), {fmt::format("space.cells={}", cells)});
    EXPECT_NEAR(found[0], (1.0 + 2.0 + 1.0) / 3.0, 1e-14) << cells;
    EXPECT_NEAR(found[1], 0.1 * 4.0 / 3.0, 1e-14) << cells;
    EXPECT_NEAR(found[2], 0.5 * (1.01 + 2.0 * 1.51 + 1.01) / 3.0, 1e-14) << cells;
  }
  const std::string h5 = files / "own.h5";
  {
    hdf5_file out = hdf5_file::create(h5);
    out.write("x", {0.25, 0.75}, {2});
    out.write("rho", {1.0, 3.0}, {2});
    out.write("u", {0.0, 0.0}, {2});
    out.write("T", {1.0, 1.0}, {2});
    out.close();
  }
  EXPECT_NEAR(totals(gas(from(h5)))[0], 2.0, 1e-14);
}

TEST(initial_file, of_other_models_is_their_state) {
  const test_folder files;
  const auto law = [](const std::string& initial) {
    return "[model]\nname = \"conservation-law\"\nvariables = [\"h\", \"q\"]\nflux = [\"q\", \"q*q/h + "
           "h*h/2\"]\n"
           "speed = 3\nepsilon = 1e-3\n" +
           initial + "[space]\ncells = 12\n[time]\nmethod = \"md-imex-3-2\"\nend = 0.01\ncfl = 0.2\n";
  };
  const std::string folder = run(law("[initial]\nh = \"1 + 0.1*sin(2*pi*x)\"\nq = 0\n"), files / "law");
  EXPECT_EQ(numbers_of(state_of(law(from(folder + "/solution.h5")))),
            hdf5_file::open(folder + "/solution.h5").read("f"));
  std::string automatic = law(from(folder + "/solution.h5"));
  automatic.erase(automatic.find("speed = 3\n"), 10);
  bad_input::expect_refused({
      {[&] { set_up(automatic); },
       {"'model.speed' cannot be chosen automatically (the initial data are not in the "
        "case); give a number"}},
      {[&] { set_up(gas(from(folder + "/solution.h5"))); },
       {"it is a result of model 'conservation-law' (the case has model 'bgk')"}},
  });
  const auto ode = [](const std::string& initial) {
    return "[model]\nname = \"ode\"\n" + initial + "[time]\nmethod = \"md-imex-3-2\"\nend = 1\ndt = 0.1\n";
  };
  const std::string point = run(ode("[initial]\nu1 = 2\n"), files / "ode");
  EXPECT_EQ(numbers_of(state_of(ode(from(point + "/solution.h5")))),
            hdf5_file::open(point + "/solution.h5").read("f"));
  EXPECT_NEAR(state_of(ode(from(point + "/fields.csv"))).row(0)[1],
              hdf5_file::open(point + "/solution.h5").read("f")[1], 1e-15);
}

TEST(initial_file, that_cannot_be_used_is_refused_with_the_key_the_place_and_a_remedy) {
  const test_folder files;
  const auto csv = [&files](const std::string& text) { return gas(from(table(files / "t.csv", text))); };
  const std::string head = "x,rho,u,T\n0.25,1,0,1\n";
  const std::string key = "c.toml:5:9: initial.file = '" + (files / "t.csv") + "' cannot be used: ";
  const std::vector<std::pair<std::string, std::string>> all = {
      {head + "0.75,-1,0,1\n", "line 3 has no Maxwellian (density -1 is not positive); change its numbers"},
      {head + "0.75,1,0,0\n", "line 3 has no Maxwellian (temperature 0 is not positive); change its numbers"},
      {head + "0.75,nan,0,1\n", "t.csv:3: 'nan' in column 'rho' is not a finite number; change it"},
      {head + "0.75,1e999,0,1\n", "t.csv:3: '1e999' in column 'rho' is not a finite number; change it"},
      {head + "0.75,,0,1\n", "t.csv:3: '' in column 'rho' is not a finite number; change it"},
      {head + "0.75,1,0\n", "t.csv:3: 3 entries (the first line names 4 columns); give 4"},
      {head + "0.25,1,0,1\n", "x does not increase in line 3 (0.25 after 0.25); sort the rows"},
      {head + "0.75,1,0,1\n1.4,1,0,1\n",
       "x is not equidistant in line 3 (0.75, where equal cells have 0.825)"},
      {head + "0.5,1,0,1\n", "its cells cover [0.125, 0.625] (the domain is [0, 1]); change space.domain"},
      {head, "it has one row (the width of a cell is not known from it); give several"},
      {"x,rho,u\n0.25,1,0\n0.75,1,0\n", "it has no column 'T' (its columns are rho, u, x); add it"},
      {"rho,u,T\n1,0,1\n1,0,1\n", "it has no column 'x' (centres of the cells); add it"},
      {"x,rho,rho,T\n", "column 'rho' appears twice (a column is found by its name); rename one of them"},
      {"x,rho,u,T\n", "the table has no rows"},
      {"", "the table has no rows"},
  };
  for (const auto& [text, says] : all) {
    SCOPED_TRACE(text);
    bad_input::expect_refused({{[&, &content = text] { set_up(csv(content)); }, {key, says}}});
  }
  bad_input::expect_refused({
      {[&] { set_up(csv(head + "0.75,1,0,1\n"), {"initial.time=1"}); },
       {"it has no times (no column 't'); remove initial.time"}},
      {[&] { set_up(gas(from(table(files / "t.txt", head)))); },
       {"its kind is not known (neither .h5 nor .csv)"}},
      {[&] { set_up(gas(from(table(files / "bad.h5", "no HDF5")))); }, {"not an HDF5 file"}},
  });
  std::filesystem::create_directory(files / "folder.csv");
  bad_input::expect_refused({
      {[&] { set_up(gas(from(files / "folder.csv"))); }, {"it is a folder"}},
  });
  {
    hdf5_file out = hdf5_file::create(files / "shape.h5");
    for (const char* name : {"x", "u", "T"}) out.write(name, {0.25, 0.75}, {2});
    out.write("rho", {1.0, 1.0, 1.0}, {3});
    out.close();
  }
  bad_input::expect_refused({
      {[&] { set_up(gas(from(files / "shape.h5"))); }, {"'rho' has 3 numbers and 'x' has 2"}},
  });
  {
    hdf5_file out = hdf5_file::create(files / "unit.h5");
    for (const char* name : {"x", "u", "T"}) out.write(name, {0.25, 0.75}, {2});
    out.write("rho", {1.0, 1.0}, {2}, "", apsis::precision::float64, "kg/m^3");
    out.close();
  }
  bad_input::expect_refused({
      {[&] { set_up(gas(from(files / "unit.h5"))); },
       {"'rho' has the unit kg/m^3 (the case has no table [gas]"}},
  });
}

TEST(initial_file, that_is_truncated_anywhere_is_refused) {
  const test_folder files;
  const std::string folder = run(gas(sod), files / "r", {"output.every=0.01", "space.cells=8"});
  const std::string whole = apsis::read_text_file(folder + "/solution.h5", 10'000'000, "result");
  for (std::size_t k = 0; k < 60; ++k) {
    apsis::write_text_file(files / "short.h5", whole.substr(0, k * 7919 % whole.size()));
    bad_input::expect_refused({
        {[&] { set_up(gas(from(files / "short.h5"))); }, {"c.toml:5:9: initial.file = "}},
    });
  }
  // A truncated table lacks rows at its end, or a part of the last one.
  const std::string table_text = "x,rho,u,T\n0.25,1.5,0.25,1.25\n0.75,1.5,0.25,1.25\n";
  for (std::size_t length = 0; length + 5 < table_text.size(); ++length) {
    apsis::write_text_file(files / "short.csv", table_text.substr(0, length));
    bad_input::expect_refused({
        {[&] { set_up(gas(from(files / "short.csv"))); }, {"c.toml:5:9: initial.file = "}},
    });
  }
}

TEST(initial_file, is_written_with_its_case_and_read_back) {
  const case_config c = parse_case(
      gas(from("a b.h5") + "time = 0.5\n[[initial.region]]\nwhere = \"x<0.1\"\nrho=1\nT=1\n"), "c.toml");
  const case_config again = parse_case(to_toml(c), "d.toml");
  EXPECT_EQ(again.prescribed.file, "a b.h5");
  EXPECT_EQ(again.prescribed.time, 0.5);
  EXPECT_EQ(again.prescribed.regions.size(), 1U);
  EXPECT_EQ(to_toml(again), to_toml(c));
}

/// The exact averages of piecewise parabolas over the cells of another mesh have the same sum.
RC_GTEST_PROP(cell_polynomials, keep_averages_totals_and_sign, ()) {
  apsis::line_rows rows;
  rows.cells = *rc::gen::inRange(1, 12);
  rows.components = 1;
  rows.lower = -1.0;
  rows.upper = 2.0;
  const double largest = std::pow(10.0, *rc::gen::inRange(-150, 150));
  for (int k = 0; k < rows.cells; ++k)
    rows.values.push_back(largest * (*rc::gen::inRange(0, 1000)) * (*rc::gen::inRange(0, 2)));
  const apsis::cell_polynomials between(rows, true);
  double total = 0.0, found = 0.0;
  for (int cell = 0; cell < rows.cells; ++cell) {
    total += rows.values[static_cast<std::size_t>(cell)];
    double average = 0.0;
    const double h = rows.width(), centre = rows.lower + (cell + 0.5) * h;
    // Gauss points of degree 3 integrate a parabola exactly.
    for (const double xi : {-0.5, 0.5}) {
      double value = 0.0;
      between(centre + xi * h / std::numbers::sqrt3, {&value, 1});
      average += 0.5 * value;
    }
    RC_ASSERT(std::abs(average - rows.values[static_cast<std::size_t>(cell)]) <= 1e-14 * 1000.0 * largest);
    found += average;
    for (int k = 0; k <= 50; ++k) {
      double value = 0.0;
      between(centre + (k / 50.0 - 0.5) * 0.999 * h, {&value, 1});
      RC_ASSERT(value >= 0.0);
    }
  }
  RC_ASSERT(std::abs(found - total) <= 1e-13 * 1000.0 * largest);
}

}  // namespace initial_file_test
