// Bodies of kind "vacuum", which absorb all molecules that arrive.
#include <apsis/config/case.hpp>
#include <apsis/run/compute_surfaces.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace absorbing_bodies_test {
namespace {

using namespace apsis;

/// Returns a case of a gas at rest around a body, between planes of symmetry.
std::string gas_around(const std::string& body, int dimensions) {
  const bool plane = dimensions == 2;
  return "[model]\nname = \"bgk\"\nepsilon = 1e6\n[initial]\nrho = 1\nT = 1\n[space]\nboundary = "
         "\"symmetry\"\n" +
         std::string(plane ? "cells = [16, 16]\ndomain = [[-1, 1], [-1, 1]]\n"
                           : "cells = [8, 8, 8]\ndomain = [[-1, 1], [-1, 1], [-1, 1]]\n") +
         "[[space.body]]\nname = \"pump\"\nkind = \"vacuum\"\n" + body +
         "[velocity]\nmax = 6\npoints = " + (plane ? "24" : "14") +
         "\n[time]\nmethod = \"md-imex-3-2\"\nend = 0.1\nsafety = 1\n[output]\nsurfaces = [\"pump\"]\n";
}

const std::string circle = "shape = \"circle\"\ncentre = [0.1, -0.05]\nradius = 0.55\n",
                  ball = "shape = \"sphere\"\ncentre = [0.1, -0.05, 0.02]\nradius = 0.6\n";

/// Returns a column of the table of the body in the last step.
std::vector<double> column(const surface_table& table, const std::string& name) {
  const auto& names = table.numbers.columns;
  const auto k = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  std::vector<double> values;
  for (const auto& row : table.numbers.rows) values.push_back(row.at(k));
  return values;
}

}  // namespace

TEST(absorbing_body, takes_the_mass_flux_of_free_molecules) {
  for (const int dimensions : {2, 3}) {
    simulation run(parse_case(gas_around(dimensions == 2 ? circle : ball, dimensions), "case.toml"));
    run.advance();
    const auto tables = run.surfaces();
    ASSERT_EQ(tables.size(), 1U);
    const auto mass = column(tables[0], "mass"), leaving = column(tables[0], "mass_leaving");
    const double efflux = 1.0 / std::sqrt(2.0 * std::numbers::pi);
    for (std::size_t k = 0; k < mass.size(); ++k) {
      // The tolerance covers the error of half of the velocities, Δv²/24 = 1 % and 3 %, and the rarefaction
      // during the first step.
      EXPECT_NEAR(mass[k], efflux, 0.15 * efflux) << dimensions << ' ' << k;
      EXPECT_EQ(leaving[k], 0.0);
    }
  }
}

TEST(absorbing_body, removes_what_the_gas_loses) {
  for (const int dimensions : {2, 3})
    for (const char* limiter : {"positivity", "none"}) {
      simulation run(parse_case(gas_around(dimensions == 2 ? circle : ball, dimensions), "case.toml",
                                {std::string("space.limiter=") + limiter}));
      const double before = run.initial_record().total.at(0);
      while (!run.finished()) run.advance();
      // The budget of mass, momentum and energy includes the amounts that the body has received.
      EXPECT_LT(run.summary().conservation_defect, 1e-13) << limiter;
      const double lost = before - run.last().total.at(0);
      EXPECT_GT(lost, 0.02 * before);
      if (limiter == std::string("positivity")) {
        EXPECT_TRUE(run.promises().positivity);
        EXPECT_GE(run.summary().min_value, 0.0);
      }
    }
}

TEST(absorbing_body, receives_what_enters_in_a_steady_state) {
  const std::string text =
      "[model]\nname = \"bgk\"\nepsilon = 0.3\n[initial]\nrho = 1\nu = [1, 0]\nT = 1\n[space]\ncells = [16, "
      "12]\n"
      "domain = [[-2, 2], [-1.5, 1.5]]\nboundary = \"symmetry\"\n[boundary.left]\nkind = \"inflow\"\nrho = "
      "1\n"
      "u = [1, 0]\nT = 1\n[boundary.right]\nkind = \"outflow\"\n[[space.body]]\nname = \"pump\"\n"
      "kind = \"vacuum\"\n" +
      circle + "[velocity]\nmax = 6\npoints = 16\n[steady]\ntolerance = 1e-9\n";
  simulation run(parse_case(text, "case.toml"));
  while (!run.finished()) run.advance();
  const auto faces = run.setup().open_faces();
  const std::size_t count = run.setup().equation->invariants().size();
  double sum = 0.0, pumped = 0.0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    sum += run.last().flux.at(f * count);
    if (faces[f] == "pump") pumped = -run.last().flux.at(f * count);
  }
  EXPECT_GT(pumped, 0.5);
  EXPECT_NEAR(sum, 0.0, 1e-7 * pumped);
}

}  // namespace absorbing_bodies_test
