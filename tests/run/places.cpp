// Errors that only the assembled simulation can detect have the line and column of the case.
#include "cases.hpp"

#include <apsis/core/errors.hpp>

#include <string>

#include <gtest/gtest.h>

namespace places_test {

namespace {

std::string deck(const std::string& cells, const std::string& velocity, const std::string& epsilon,
                 const std::string& time) {
  return "[model]\nname = \"bgk\"\nepsilon = " + epsilon + "\n[space]\ncells = " + cells +
         "\nlimiter = \"positivity\"\n[velocity]\n" + velocity + "\n[time]\n" + time + "\nend = 0.1\n";
}

std::string complaint(const std::string& text) {
  try {
    const apsis::simulation run(apsis::parse_case(text, "my.toml"));
  } catch (const apsis::input_error& e) {
    return e.what();
  }
  return "";
}

const std::string good_velocity = "max = 9\npoints = 36";
const std::string good_time = "method = \"md-imex-3-2\"\ncfl = 0.05";

}  // namespace

TEST(places, of_errors_in_the_mesh_the_velocity_grid_and_the_method) {
  EXPECT_EQ(complaint(deck("20", good_velocity, "1.0", good_time)), "");
  const auto starts = [](const std::string& message, const std::string& start) {
    EXPECT_EQ(message.substr(0, start.size()), start) << message;
  };
  starts(complaint(deck("4", good_velocity, "1.0", good_time)),
         "my.toml:5:1: space.cells: a mesh of 4 cells is smaller than the");
  starts(complaint(deck("20", "max = 2\npoints = 36", "1.0", good_time)),
         "my.toml:8:1: velocity.max = 2 is too small");
  starts(complaint(deck("20", "max = 20\npoints = 12", "1.0", good_time)),
         "my.toml:9:1: velocity.points = 12 is too");
  starts(complaint(deck("20", good_velocity, "\"x - 0.5\"", good_time)),
         "my.toml:3:12: expression 'x - 0.5' is -");
  starts(complaint(deck("20", good_velocity, "1.0", "method = \"imdrk-2-3\"\ncfl = 0.05")),
         "my.toml:11:1: method 'imdrk-2-3' cannot integrate");
  starts(complaint(deck("20", good_velocity, "1.0", "method = \"dirk-2-2\"\ncfl = 0.05")),
         "my.toml:11:1: method 'dirk-2-2' cannot integrate");
}

}  // namespace places_test
