#include "compared_transport.hpp"

#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <gmock/gmock.h>

namespace device_transport_test {

using apsis::field;
using apsis::grid;
using apsis::target;
using limits = apsis::limited_reconstruction::limits;

std::unique_ptr<apsis::model> gas(const std::string& name, int dimensions, int points) {
  apsis::model_config config = apsis::default_config(apsis::find_model(name));
  config.space_dimensions = dimensions;
  config.velocity = {4.0, points, apsis::equilibrium_choice::automatic};
  return apsis::find_model(name).make(config);
}

/// Returns a boundary of a kind with usual values. Its values change in time if `moving`.
std::shared_ptr<const apsis::boundary> end_of(const apsis::boundary_entry& kind, const apsis::model& equation,
                                              bool moving) {
  apsis::face_quantities values;
  for (const auto& variable :
       kind.variables != nullptr ? kind.variables(equation) : std::vector<apsis::data_variable>()) {
    if (values.contains(variable.alternative)) continue;
    const double number = variable.value ? *variable.value : variable.of_velocity ? 0.1 : 1.0;
    const apsis::face_quantity::function of_time = [number](double t, const apsis::position&) {
      return number * (1.0 - 0.01 * t);
    };
    values[variable.name].assign(static_cast<std::size_t>(variable.size),
                                 moving ? apsis::face_quantity(of_time) : apsis::face_quantity(number));
  }
  return apsis::make_boundary(kind.name, equation, values);
}

/// Returns a gas in 1 to 3 dimensions. It is periodic or has one kind of boundary at all faces, with or
/// without a box in it.
device_case flow(int dimensions, const apsis::boundary_entry& kind, bool with_box) {
  // On a line there are more cells than one piece of a sweep has.
  std::array<int, 3> cells = {dimensions == 1 ? 45 : 9, dimensions > 1 ? 7 : 1, dimensions > 2 ? 5 : 1};
  device_case made{kind.name + " in " + std::to_string(dimensions),
                   gas("bgk", dimensions,
                       dimensions == 1   ? 21
                       : dimensions == 2 ? 8
                                         : 6),
                   grid(dimensions, cells, {0, 0, 0}, {1, 1.5, 2})};
  if (with_box)
    made.mesh = made.mesh.with_solids({{.first = {4, 2, dimensions == 3 ? 2 : 0}, .cells = {2, 2, 1}}});
  const auto side =
      kind.name == "periodic" ? apsis::make_boundary("periodic") : end_of(kind, *made.equation, true);
  made.sides.assign(static_cast<std::size_t>(dimensions), {side, side});
  if (with_box) made.solids.push_back(apsis::make_boundary("diffuse", *made.equation));
  return made;
}

TEST(device_transport, has_the_bits_of_the_host_with_every_scheme_and_order_of_lanes) {
  for (const auto* scheme : apsis::reconstruction_entries())
    for (const limits limited : {limits::nothing, limits::fluxes}) {
      if (limited == limits::fluxes && scheme->make()->order() == 1) continue;
      for (const auto& on : tested_devices()) {
        const device_case line = flow(1, apsis::find_boundary("periodic"), false);
        EXPECT_EQ(differences(line, scheme->name, limited, *on), 0)
            << scheme->name << (limited == limits::fluxes ? " with limited fluxes" : "");
      }
    }
}

TEST(device_transport, has_the_bits_of_the_host_with_every_boundary_in_one_to_three_dimensions) {
  for (const auto* kind : apsis::boundary_entries()) {
    if (kind->name == "axis") continue;  // needs axisymmetric flow, which the device refuses
    const bool in_space = kind->name == "diffuse" || kind->name == "outflow";  // tests in space take long
    for (int dimensions = 1; dimensions <= (in_space ? 3 : 2); ++dimensions)
      for (const bool with_box : {false, true}) {
        if (with_box && dimensions == 1) continue;
        const device_case of = flow(dimensions, *kind, with_box);
        for (const limits limited : {limits::nothing, limits::fluxes})
          EXPECT_EQ(differences(of, "weno5-z", limited, *tested_device()), 0)
              << of.label << (with_box ? " with a box" : "")
              << (limited == limits::fluxes ? " with limited fluxes" : "");
      }
  }
}

TEST(device_transport, has_the_bits_of_the_host_with_sources_of_every_kind) {
  struct kind {
    const char* label;
    bool in_time, of_state;
  };
  for (const kind& one :
       {kind{"steady", false, false}, {"in time", true, false}, {"of the state", false, true}})
    for (const auto& on : tested_devices()) {
      const device_case of = flow(2, apsis::find_boundary("diffuse"), true);
      apsis::source_rate rate;
      rate.steady = !one.in_time && !one.of_state;
      rate.value = [one](double t, const apsis::position& x, std::span<const double> u,
                         std::span<double> row) {
        const double size = (1.0 + x[0]) * (one.in_time ? 1.0 + std::sin(9.0 * t) : 1.0);
        for (std::size_t k = 0; k < row.size(); ++k)
          row[k] = one.of_state ? 0.1 * u[k] * u[k] : size / (1.0 + static_cast<double>(k));
      };
      if (one.of_state)
        rate.growth = [](double, const apsis::position&, std::span<const double> u) { return 0.2 * u[0]; };
      const apsis::limited_reconstruction edges{apsis::find_reconstruction("weno5-z").make(), limits::fluxes};
      apsis::upwind_transport host(*of.equation, of.space(), edges, apsis::point_values());
      apsis::device_transport there(*on, *of.equation, of.space(), edges, apsis::point_values(),
                                    apsis::kernel_of_reconstruction("weno5-z"));
      host.set_source(rate);
      there.set_source(rate);
      const field u = varied_rows(of.mesh, *of.equation, true);
      EXPECT_EQ(differences_of_transport(of.mesh, u, host, there, *on), 0) << one.label;
      field sent(of.mesh.size(), u.components(), on->memory());
      sent.copy_rows(u);
      EXPECT_EQ(host.source_depends_on_state(), there.source_depends_on_state());
      EXPECT_EQ(host.growth_of_source(0.3, u), there.growth_of_source(0.3, sent)) << one.label;
    }
}

TEST(device_transport, combines_states_like_the_host) {
  const device_case of = flow(2, apsis::find_boundary("diffuse"), true);
  const apsis::limited_reconstruction edges{apsis::find_reconstruction("upwind5").make(), limits::nothing};
  const auto& on = tested_device();
  const apsis::upwind_transport host(*of.equation, of.space(), edges, apsis::point_values());
  const apsis::device_transport there(*on, *of.equation, of.space(), edges, apsis::point_values(),
                                      apsis::kernel_of_reconstruction("upwind5"));
  const int components = of.equation->components();
  const field u = varied_rows(of.mesh, *of.equation, true);
  field sent(of.mesh.size(), components, on->memory());
  sent.copy_rows(u);
  // The largest sum has more terms than one launch. The result is the first term of its own sum.
  for (const std::size_t terms : {1ul, 3ul, 11ul})
    for (const double first : {1.0, 0.7}) {
      field sum = u, on_device = sent, back(of.mesh.size(), components);
      std::vector<apsis::linear_term<field, double>> here, away;
      for (std::size_t k = 0; k < terms; ++k) {
        const double alpha = k == 0 ? first : 0.1 * static_cast<double>(k) - 0.3;
        here.push_back({alpha, k == 0 ? &sum : &u});
        away.push_back({alpha, k == 0 ? &on_device : &sent});
      }
      host.combine(here, sum);
      there.combine(away, on_device);
      back.copy_rows(on_device);
      EXPECT_EQ(different_numbers(of.mesh, sum, back), 0) << terms;
    }
}

TEST(device_transport, refuses_what_it_does_not_have) {
  const device_case of = flow(1, apsis::find_boundary("periodic"), false);
  const auto& on = tested_device();
  const auto make = [&](limits limited) {
    return apsis::device_transport(*on, *of.equation, of.space(),
                                   {apsis::find_reconstruction("weno5-z").make(), limited},
                                   apsis::point_values(), apsis::kernel_of_reconstruction("weno5-z"));
  };
  EXPECT_THAT([&] { make(limits::edges); },
              testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("edge values are limited")));
  auto t = make(limits::nothing);
  EXPECT_THAT([&] { t.set_rotation(1); },
              testing::ThrowsMessage<apsis::input_error>(testing::HasSubstr("axisymmetric flow is not")));
}

}  // namespace device_transport_test
