// Gases past random bodies in the plane and in space stay nonnegative and conserve, for every convex method.
// Runs have more than 1e9 point·stages.
#include "longest_steps.hpp"

#include <apsis/config/case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/method/method.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <support/catalogue.hpp>

namespace body_positivity_test {
namespace {

/// Draws cases with random bodies, walls, ends and rarefactions, and some with a force. In parts of the
/// domain the gas is nearly a vacuum. No expression draws twice, so all compilers draw the same cases.
class random_bodies {
 public:
  explicit random_bodies(unsigned seed) : generator_(seed) {}

  std::string next(const std::string& model, const std::string& method, int dimensions) {
    const bool plane = dimensions == 2;
    std::string text =
        fmt::format("[model]\nname = \"{}\"\nepsilon = {:g}\n", model, std::pow(10.0, number(-8.0, 6.0)));
    if (model == "shakhov") text += "tails = \"nonnegative\"\n";
    text += fmt::format("[initial]\nrho = \"x > {:.3f} ? 1 : 1e-12\"\n", number(-0.8, 0.5));
    text += fmt::format("u = [{:.3f}, 0.3{}]\nT = \"y > 0 ? 0.6 : 1.2\"\n", number(-1.0, 1.0),
                        plane ? "" : ", 0");
    text += plane ? "[space]\ncells = [18, 18]\ndomain = [[-1, 1], [-1, 1]]\n"
                  : "[space]\ncells = [10, 10, 10]\ndomain = [[-1, 1], [-1, 1], [-1, 1]]\n";
    text += "boundary = \"" + pick({"outflow", "symmetry", "diffuse"}) + "\"\n";
    for (int body = 0; body < (plane ? 2 : 1); ++body) text += table(dimensions);
    if (number(0.0, 1.0) < 0.3) text += "[force]\nacceleration = [\"0.5*y\", \"-0.4*cos(3*t)\"]\n";
    return text +
           fmt::format("[velocity]\nmax = 6\npoints = {}\n[time]\nmethod = \"{}\"\nsafety = 1\nend = 1e9\n",
                       plane ? 14 : 10, method);
  }

 private:
  double number(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(generator_);
  }
  std::string pick(const std::vector<std::string>& from) {
    return from[std::uniform_int_distribution<std::size_t>(0, from.size() - 1)(generator_)];
  }
  std::string vector(int d, double from, double to) {
    std::string text;
    for (int k = 0; k < d; ++k) text += (k > 0 ? ", " : "") + fmt::format("{:.4f}", number(from, to));
    return "[" + text + "]";
  }
  std::string round(int d) {
    const bool plane = d == 2;
    const std::string centre = "centre = " + vector(d, -0.9, 0.9) + "\n";
    if (number(0.0, 1.0) < 0.7)
      return (plane ? "shape = \"circle\"\n" : "shape = \"sphere\"\n") + centre +
             fmt::format("radius = {:.4f}\n", number(0.3, 0.7));
    const std::string axes = "semi_axes = " + vector(d, 0.35, 0.8) + "\n";
    return (plane ? "shape = \"ellipse\"\n" : "shape = \"ellipsoid\"\n") + centre + axes +
           (plane ? fmt::format("angle = {:.1f}\n", number(0.0, 180.0)) : "");
  }
  /// Returns a box, turned in half of the cases, or a polygon. Polygons are extruded in space.
  std::string with_edges(int d) {
    const bool plane = d == 2;
    const std::string turn = plane ? "rotate = " : "rotate = [0.5, -1, 0.8, ";
    std::string text = "shift = " + vector(d, -0.9, 0.9) + "\n";
    text += turn + fmt::format("{:.1f}{}\n", std::max(number(-90.0, 90.0), 0.0), plane ? "" : "]");
    if (number(0.0, 1.0) < 0.5) {
      const std::string from = vector(d, -0.6, -0.3);
      return text + "shape = \"box\"\nfrom = " + from + "\nto = " + vector(d, 0.3, 0.6) + "\n";
    }
    std::string points;
    const int corners = number(0.0, 1.0) < 0.5 ? 3 : 5;
    for (int k = 0; k < corners; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + number(0.0, 0.4)) / corners, r = number(0.5, 0.9);
      points +=
          fmt::format("{}[{:.4f}, {:.4f}]", k > 0 ? ", " : "", r * std::cos(angle), r * std::sin(angle));
    }
    return text + (plane ? "shape = \"polygon\"\npoints = [" + points + "]\n"
                         : "shape = \"extruded\"\nof = [{ shape = \"polygon\", points = [" + points +
                               "] }]\nfrom = -0.5\nto = 0.6\n");
  }
  std::string table(int d) {
    std::string text = "[[space.body]]\n" + (number(0.0, 1.0) < 0.5 ? round(d) : with_edges(d));
    const double first = number(0.0, 1.0);
    if (first < 0.3) return text + (first < 0.2 ? "kind = \"symmetry\"\n" : "kind = \"vacuum\"\n");
    const double T = number(0.4, 2.0), kind = number(0.0, 1.0);
    if (kind < 0.2)
      text += "kind = \"adiabatic\"\n";
    else if (kind < 0.4)
      text += fmt::format("kind = \"radiating\"\nsigma = 0.3\nsurroundings = {:.3f}\n", T);
    else
      text += fmt::format("T = {:.3f}\n", T);
    return text + "accommodation = " + pick({"1", "1", "0.4"}) + "\n";
  }

  std::mt19937 generator_;
};

/// Every other case has steps r Δt_FE. The cases in between have the longest steps that are linearly stable.
void expect_nonnegative(int dimensions, int steps, double point_stages, unsigned seed) {
  random_bodies cases(seed);
  const auto methods = methods_where(is_convex_at_every_epsilon);
  const std::vector<std::string> models = {"bgk", "bgk", "shakhov", "es-bgk"};
  double done = 0.0, defect = 0.0;
  int complete = 0, ended = 0, refused = 0;
  for (std::size_t k = 0; done < point_stages && !testing::Test::HasFailure(); ++k) {
    const std::string& method = methods[k % methods.size()];
    const std::string text = cases.next(models[k % models.size()], method, dimensions);
    try {
      const bool longest = (k + k / methods.size()) % 2 == 0;
      const std::string dt = longest ? steps_of_positivity(text) : std::string("time.safety=1");
      apsis::simulation run(apsis::parse_case(text, "random.toml", {dt}));
      ASSERT_TRUE(run.promises().positivity) << text;
      for (int step = 0; step < steps; ++step) run.advance();
      ++complete;
      ASSERT_EQ(run.summary().negative_values, 0) << text;
      defect = std::max(defect, run.summary().conservation_defect);
      done += static_cast<double>(run.step()) * static_cast<double>(run.state().size()) *
              static_cast<double>(apsis::find_method(method).stages());
    } catch (const apsis::numerical_error& failure) {
      // A run ends if its gas or a wall becomes too hot or too cold for the velocities.
      ASSERT_THAT(failure.what(), testing::AnyOf(testing::HasSubstr("no Maxwellian has the state outside"),
                                                 testing::HasSubstr("is too small for the gas"),
                                                 testing::HasSubstr("has no temperature that balances")))
          << text;
      ++ended;
    } catch (const apsis::input_error& failure) {
      ASSERT_THAT(failure.what(), testing::AnyOf(testing::HasSubstr("is thinner than a cell"),
                                                 testing::HasSubstr("has no wall in the domain")))
          << text;
      ++refused;
    }
  }
  EXPECT_GT(complete, ended + refused);
  EXPECT_LT(defect, 1e-12);
}

}  // namespace

TEST(body_positivity, quick_in_the_plane) {
  expect_nonnegative(2, 10, 6e7, 1);
}

TEST(body_positivity, quick_in_space) {
  expect_nonnegative(3, 4, 6e7, 2);
}

TEST(SLOW_body_positivity, holds_for_1e9_point_stages_in_the_plane_and_in_space) {
  expect_nonnegative(2, 25, 6e8, 3);
  expect_nonnegative(3, 10, 6e8, 4);
}

}  // namespace body_positivity_test
