// Every kind of boundary on every face and around solid boxes. The values are formulas of time and of the
// position along the face, including corners.
#include "laws.hpp"
#include "placed_case.hpp"

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace every_face_test {

namespace {

/// Returns the keys of a monatomic gas.
std::string gas_with(const std::string& velocity, const std::string& step) {
  return fmt::format(
      "[model]\nname = \"bgk\"\nepsilon = 0.05\ndegrees_of_freedom = 3\n[velocity]\n{}\n[time]\n"
      "method = \"md-imex-3-2\"\n{}\nend = 0.02\n",
      velocity, step);
}

const placed_wall moving_plate = {
    "diffuse",
    {{"T", "1.2 + 0.2*sin(2*{Y} + 30*t)"}, {"accommodation", "0.6 + 0.3*cos(3*{Y} - {Z})"}},
    "velocity",
    {"0", "0.3*cos({Y} + 20*t)", "0.2*sin({Y})"}};
const placed_wall entering = {"inflow",
                              {{"rho", "1 + 0.3*sin(3*{Y})"}, {"T", "1 + 0.1*cos(40*t + {Y})"}},
                              "u",
                              {"-0.3", "0.2*{Y}", "0.1"}};
const placed_wall far_away = {"far-field",
                              {{"rho", "1 + 0.2*{X}"}, {"T", "1 - 0.1*{X}*cos(30*t)"}},
                              "u",
                              {"0.1", "0.2*sin({X})", "-0.1"}};
const placed_wall reservoir = {
    "pressure", {{"p", "1.1 + 0.3*sin(2*{X} - 50*t)"}, {"T", "1 + 0.2*{X}"}}, "", {}};
const placed_wall inlet = {
    "mass-flow", {{"flux", "0.1 + 0.2*{X} + 0.1*cos(40*t)"}, {"T", "1 + 0.2*{X}"}}, "", {}};
const placed_wall insulated = {"adiabatic",
                               {{"accommodation", "0.8 - 0.2*{Y}"}},
                               "velocity",
                               {"0", "0.3*cos({Y} + 20*t)", "0.2*sin({Y})"}};
const placed_wall black = {
    "radiating",
    {{"emissivity", "0.5 + 0.3*{Y}"}, {"sigma", "0.4"}, {"surroundings", "0.8 + 0.1*{Y}"}},
    "",
    {}};
const placed_wall mirror = {"symmetry", {}, "", {}}, open = {"outflow", {}, "", {}};
const placed_wall lid = {"diffuse", {{"T", "1 + 0.3*{X}"}}, "velocity", {"0.4*cos(2*{X})", "0", "0"}};
const placed_wall start = {
    "",
    {{"rho", "1 + 0.3*sin({X} + 2*{Y}) + 0.1*{Z}"}, {"T", "1 + 0.2*cos({X} - {Y} + {Z})"}},
    "u",
    {"0.2*{Y}", "0.3*sin({X})", "0.1*{X}"}};
const placed_wall box = {
    "diffuse", {{"T", "1.1 + 0.2*{X} - 0.3*{Y}*cos(30*t)"}, {"accommodation", "0.7 + 0.2*{X}"}}, "", {}};

/// Returns a wall with the incoming distribution as a formula that distinguishes all axes.
placed_wall given(std::size_t dimensions) {
  const std::string f = "0.05*(1 + 0.3*sin(3*{Y} + 40*t))*exp(-0.6*({VX} - 0.2)^2 - 0.4*({VY} + 0.3*{X})^2";
  if (dimensions == 3) return {"given", {{"f", f + " - 0.5*{VZ}^2)"}}, "", {}};
  return {"given", {{"g", f + ")"}, {"h", "1.2*" + f + ")"}}, "", {}};
}

placed_case in_the_plane(const std::vector<placed_wall>& faces, const std::string& step = "dt = 0.002") {
  return {gas_with("max = 7\npoints = 14", step),    2,  {8, 7, 1}, {1.0, 0.7, 0.0}, start, faces,
          {{{-0.25, 0.5}, {-0.1, 0.3}, {0.0, 0.0}}}, box};
}

placed_case in_space(const std::vector<placed_wall>& faces, const std::string& step = "dt = 0.002") {
  return {gas_with("max = 6.5\npoints = 8", step),    3,  {6, 5, 7}, {0.9, 1.0, 1.4}, start, faces,
          {{{-0.3, 0.3}, {-0.2, 0.6}, {-1.4, -0.2}}}, box};
}

/// Compares a case with its images. The state has `sets` sets of points^d components.
void expect_images(const placed_case& of, const std::vector<placement>& images, std::size_t points,
                   std::size_t sets) {
  const auto before = finished_run(of.text({}), {}).state();
  for (const placement& to : images)
    // Sums over velocities have another order, and WENO weights divide by squares of differences.
    EXPECT_LT(of.difference(before, finished_run(of.text(to), {}).state(), to, points, sets), 1e-13)
        << of.text(to);
}

/// The four rotations of the plane and their mirror images.
const std::vector<placement> of_the_plane = {
    {{1, 0, 2}, {1, -1, 1}}, {{0, 1, 2}, {-1, -1, 1}}, {{1, 0, 2}, {-1, 1, 1}}, {{0, 1, 2}, {-1, 1, 1}},
    {{0, 1, 2}, {1, -1, 1}}, {{1, 0, 2}, {1, 1, 1}},   {{1, 0, 2}, {-1, -1, 1}}};

/// Mappings of a box that map each face to each other face.
const std::vector<placement> of_space = {{{1, 2, 0}, {1, 1, 1}},
                                         {{2, 0, 1}, {1, 1, 1}},
                                         {{0, 1, 2}, {-1, -1, -1}},
                                         {{1, 2, 0}, {-1, -1, -1}},
                                         {{2, 0, 1}, {-1, -1, -1}}};

/// Returns a gas at rest with a solid box at two of its faces and another one inside.
std::string at_rest(int dimensions, const std::string& kind, const std::string& values) {
  std::string text = dimensions == 2
                         ? "[model]\nname = \"bgk\"\ndegrees_of_freedom = 3\n[initial]\nrho = 1.3\nT = 0.9\n"
                           "[space]\ncells = [9, 8]\ndomain = [[0, 0.9], [0, 0.8]]\n"
                           "[velocity]\nmax = 6\npoints = 12\n"
                         : "[model]\nname = \"bgk\"\n[initial]\nrho = 1.3\nT = 0.9\n"
                           "[space]\ncells = [6, 5, 7]\ndomain = [[0, 0.6], [0, 0.5], [0, 0.7]]\n"
                           "[velocity]\nmax = 6\npoints = 8\n";
  text += "[time]\nmethod = \"md-imex-3-2\"\nsafety = 1\nend = 0.02\n";
  const std::vector<std::string> faces = {"left", "right", "bottom", "top", "back", "front"};
  for (std::size_t k = 0; k < 2 * static_cast<std::size_t>(dimensions); ++k)
    text += fmt::format("[boundary.{}]\nkind = \"{}\"\n{}", faces[k], kind, values);
  if (kind == "periodic") return text;
  const std::vector<std::pair<std::string, std::string>> boxes = {{"[0, 0, 0.3]", "[0.2, 0.1, 0.4]"},
                                                                  {"[0.3, 0.2, 0]", "[0.4, 0.3, 0.4]"}};
  for (const auto& [from, to] : boxes) {
    const auto corner = [&](const std::string& of) {
      return dimensions == 3 ? of : of.substr(0, of.rfind(',')) + "]";
    };
    text += fmt::format("[[space.solid]]\nfrom = {}\nto = {}\nkind = \"{}\"\n{}", corner(from), corner(to),
                        kind, values);
  }
  return text;
}

/// Returns values that match a gas with density 1.3 and temperature 0.9, but that the program cannot
/// recognise as constants.
std::string matching_values(int dimensions, const std::string& kind) {
  const std::string zero = " + 0*t*x*y\"\n";
  if (kind == "diffuse") return "T = \"0.9" + zero + "accommodation = \"0.7" + zero;
  if (kind == "mass-flow") return "flux = \"0" + zero + "T = \"0.9" + zero;
  if (kind == "adiabatic") return "accommodation = \"0.7" + zero;
  if (kind == "radiating") return "sigma = \"0.3" + zero + "surroundings = \"0.9" + zero;
  if (kind == "pressure") return "p = \"1.3*0.9" + zero + "T = \"0.9" + zero;
  if (kind == "inflow" || kind == "far-field") return "rho = \"1.3" + zero + "u = 0\nT = \"0.9" + zero;
  if (kind != "given") return "";
  // Two values of the discrete Maxwellian determine a and b in exp(a − b v²).
  const apsis::simulation run(apsis::parse_case(at_rest(dimensions, "periodic", ""), "rest"));
  const auto row = run.row(0);
  const auto points = static_cast<std::size_t>(run.setup().equation->velocities().size());
  const auto square = [&](std::size_t j) {
    double sum = 0.0;
    for (int k = 0; k < dimensions; ++k) sum += std::pow(run.setup().equation->velocities().speeds(k)[j], 2);
    return sum;
  };
  const double b = std::log(row[points / 2] / row[0]) / (square(0) - square(points / 2)),
               a = std::log(row[0]) + b * square(0);
  const std::string f =
      fmt::format("exp({:.17g} - {:.17g}*(v_x^2 + v_y^2{}))", a, b, dimensions == 3 ? " + v_z^2" : "");
  if (dimensions == 3) return fmt::format("f = \"{}\"\n", f);
  return fmt::format("g = \"{0}\"\nh = \"0.9*{0}\"\n", f);
}

}  // namespace

TEST(every_face, keeps_a_gas_at_rest_that_matches_it) {
  for (const int dimensions : {2, 3})
    for (const std::string& kind : apsis::boundary_names()) {
      // No gas at rest matches a vacuum, and an axis needs axisymmetric flow.
      if (kind == "vacuum" || kind == "axis") continue;
      const std::string text = at_rest(dimensions, kind, matching_values(dimensions, kind));
      std::vector<std::string> all = {"0.01"};
      if (dimensions == 2) all.insert(all.end(), {"0", "1e12"});
      for (const std::string& epsilon : all) {
        apsis::simulation run(
            apsis::parse_case(text, kind, {"model.epsilon=" + epsilon, "space.limiter=positivity"}));
        const auto before = run.state();
        finish(run);
        const auto after = run.state();
        double largest = 0.0;
        for (std::size_t k = 0; k < after.size(); ++k)
          largest = std::max(largest, std::abs(after[k] - before[k]));
        EXPECT_GE(run.step(), 3);
        // A stage has some roundings of values up to 0.2, and of the exponent of a given formula.
        EXPECT_LT(largest, 3e-14) << dimensions << " " << kind << " " << epsilon;
      }
    }
}

TEST(every_face, of_the_plane_has_every_kind_with_formulas_along_it) {
  expect_images(in_the_plane({moving_plate, entering, far_away, reservoir}), of_the_plane, 14, 2);
  expect_images(in_the_plane({given(2), open, mirror, lid}), of_the_plane, 14, 2);
  expect_images(in_the_plane({insulated, black, inlet, open}), of_the_plane, 14, 2);
}

TEST(every_face, of_space_has_every_kind_with_formulas_along_it) {
  expect_images(in_space({moving_plate, entering, far_away, reservoir, given(3), mirror}), of_space, 8, 1);
}

TEST(every_face, meets_others_in_corners_without_a_loss) {
  // The plates have different temperatures and accommodation. They rest or move. The gas has a
  // vacuum beside it.
  const placed_wall cold = {"diffuse", {{"T", "0.9 + 0.1*sin(3*{X})"}, {"accommodation", "0.3"}}, "", {}},
                    hot = {"diffuse", {{"T", "1.6 + 0.3*{Y}"}, {"accommodation", "1"}}, "", {}};
  const std::vector<placed_wall> plates = {moving_plate, hot, cold, lid};
  std::vector<placed_wall> of_a_box = plates;
  of_a_box.insert(of_a_box.end(), {hot, cold});
  for (const placed_case& cavity : {in_the_plane(plates, "safety = 1"), in_space(of_a_box, "safety = 1")})
    for (const char* epsilon : {"model.epsilon=0", "model.epsilon=1e-3", "model.epsilon=1e12"}) {
      apsis::simulation run(
          apsis::parse_case(cavity.text({}), "cavity", {epsilon, "initial.rho=x + y < 0 ? 1 : 1e-12"}));
      EXPECT_TRUE(run.promises().positivity && run.promises().conservation);
      finish(run);
      EXPECT_EQ(run.summary().negative_values, 0);
      // About 20 steps of 3 stages, as in the promise.
      EXPECT_LT(run.summary().conservation_defect, 1e-13);
      const std::size_t count = run.setup().equation->invariants().size();
      double energy = 0.0;
      for (std::size_t face = 0; face < run.setup().open_faces().size(); ++face) {
        EXPECT_NEAR(run.last().received[face * count], 0.0, 1e-15) << run.setup().open_faces()[face];
        energy = std::max(energy, std::abs(run.last().received[face * count + count - 1]));
      }
      EXPECT_GT(energy, 1e-5);  // the plates do heat and cool the gas
    }
}

}  // namespace every_face_test
