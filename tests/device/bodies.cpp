// Flow past bodies on a device has the bits of the host.
#include "compared_transport.hpp"

#include <apsis/mesh/cut_cells.hpp>

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace device_bodies_test {

using apsis::grid;
using apsis::outside_function;
using apsis::position;
using limits = apsis::limited_reconstruction::limits;

outside_function ball(position centre, double r) {
  return [=](const position& at) {
    return std::hypot(at[0] - centre[0], at[1] - centre[1], at[2] - centre[2]) - r;
  };
}

/// A wall of bodies: the kind of boundary and its values.
struct wall {
  std::string kind = "diffuse";
  apsis::face_quantities values = {};
};

/// Returns a gas past bodies in a square or cube of side 2, with boundaries of a kind at all faces.
device_case past(const std::vector<outside_function>& bodies, const std::string& ends, const wall& of,
                 int dimensions = 2) {
  apsis::model_config config = apsis::default_config(apsis::find_model("bgk"));
  config.space_dimensions = dimensions;
  config.velocity = {4.0, dimensions == 2 ? 8 : 6, apsis::equilibrium_choice::automatic};
  config.parameters["velocity_dimensions"] = dimensions;
  const int cells = dimensions == 2 ? 18 : 10;
  const grid plain(dimensions, {cells, cells, dimensions > 2 ? cells : 1}, {-1, -1, -1}, {1, 1, 1});
  const bool repeats = ends == "periodic";
  device_case made{ends + " past " + of.kind, apsis::find_model("bgk").make(config),
                   plain.with_cut_cells(std::make_shared<apsis::cut_cells>(
                       plain, bodies, std::array{repeats, repeats, repeats}))};
  const auto side = repeats ? apsis::make_boundary(ends) : apsis::make_boundary(ends, *made.equation);
  made.sides.assign(static_cast<std::size_t>(dimensions), {side, side});
  for (int body = 0; body < made.mesh.obstacles(); ++body)
    made.solids.push_back(apsis::make_boundary(of.kind, *made.equation, of.values));
  return made;
}

/// Compares a flow with and without limiter.
void expect_the_bits_of_the_host(const device_case& of, const std::string& scheme = "weno5-z") {
  for (const limits limited : {limits::nothing, limits::fluxes}) {
    if (limited == limits::fluxes && apsis::find_reconstruction(scheme).make()->order() == 1) continue;
    EXPECT_EQ(differences(of, scheme, limited, *tested_device()), 0)
        << of.label << " with " << scheme << (limited == limits::fluxes ? " and limited fluxes" : "");
  }
}

/// Two discs. Small cells beside them share unknowns with their neighbours.
const std::vector<outside_function> discs = {ball({0.21, 0.13, 0}, 0.4), ball({-0.42, -0.3, 0}, 0.25)};

TEST(device_bodies, have_the_bits_of_the_host_with_every_wall) {
  // The wall turns about the centre of the disc.
  const apsis::face_quantity::function along_x = [](double t, const position& x) {
    return (0.1 + t) * (0.13 - x[1]);
  };
  const apsis::face_quantity::function along_y = [](double t, const position& x) {
    return (0.1 + t) * (x[0] - 0.21);
  };
  expect_the_bits_of_the_host(
      past({discs.front()}, "outflow", {"diffuse", {{"T", {1.3}}, {"velocity", {along_x, along_y}}}}));
  expect_the_bits_of_the_host(past(discs, "periodic", {"diffuse", {{"accommodation", {0.4}}}}));
  expect_the_bits_of_the_host(past(discs, "periodic", {"symmetry"}));
  expect_the_bits_of_the_host(past(discs, "outflow", {"vacuum"}));
  expect_the_bits_of_the_host(past(discs, "periodic", {}), "upwind1");
}

TEST(device_bodies, have_the_bits_of_the_host_where_they_cross_the_ends_of_the_flow) {
  expect_the_bits_of_the_host(past({ball({-0.95, 0.03, 0}, 0.41)}, "diffuse", {}));
  expect_the_bits_of_the_host(past({ball({0.07, -1.0, 0}, 0.5)}, "symmetry", {}), "upwind5");
  const outside_function below = ball({0.07, -1.0, 0}, 0.5), above = ball({0.07, 1.0, 0}, 0.5);
  const outside_function both = [=](const position& at) { return std::min(below(at), above(at)); };
  expect_the_bits_of_the_host(past({both}, "periodic", {}), "teno5");
}

TEST(device_bodies, have_the_bits_of_the_host_in_space) {
  expect_the_bits_of_the_host(
      past({ball({0.1, -0.05, 0.03}, 0.55)}, "outflow", {"diffuse", {{"accommodation", {0.5}}}}, 3));
  expect_the_bits_of_the_host(past({ball({0.1, -0.05, 0.03}, 0.55)}, "periodic", {"symmetry"}, 3));
}

}  // namespace device_bodies_test
