#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/semidiscrete_problem.hpp>
#include <apsis/semidiscrete/upwind_transport.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <support/property.hpp>

/// Returns a small BGK model for tests of the operators.
inline std::unique_ptr<apsis::relaxation_model> small_bgk(int points = 40, double max = 8.0,
                                                          int dimensions = 1) {
  apsis::model_config config = apsis::default_config(apsis::find_model("bgk"));
  config.space_dimensions = dimensions;
  config.velocity = {max, points, apsis::equilibrium_choice::automatic};
  auto made = apsis::find_model("bgk").make(config);
  return std::unique_ptr<apsis::relaxation_model>(dynamic_cast<apsis::relaxation_model*>(made.release()));
}

inline apsis::limited_reconstruction scheme(const std::string& name,
                                            apsis::limited_reconstruction::limits positivity) {
  return {apsis::find_reconstruction(name).make(), positivity};
}

inline std::shared_ptr<apsis::domain> space_of(const apsis::grid& mesh,
                                               const std::string& kind = "periodic") {
  return std::make_shared<apsis::domain>(apsis::make_domain(mesh, kind));
}

/// Returns the transport without a source, which does not use the meaning of the unknowns.
inline apsis::upwind_transport upwind(const apsis::model& m, std::shared_ptr<apsis::domain> space,
                                      apsis::limited_reconstruction edges) {
  return {m, std::move(space), std::move(edges), apsis::point_values()};
}

/// Returns a problem with such a transport.
inline apsis::semidiscrete_problem upwind_problem(const apsis::model& m,
                                                  const std::shared_ptr<apsis::domain>& space,
                                                  apsis::limited_reconstruction edges,
                                                  std::unique_ptr<apsis::collision> q) {
  return {m, space,
          std::make_unique<apsis::upwind_transport>(m, space, std::move(edges), apsis::point_values()),
          std::move(q)};
}

/// Returns nonnegative rows with zeros, jumps and values of very different magnitudes.
inline apsis::field random_rows(const apsis::grid& mesh, int components) {
  apsis::field u(mesh.size(), components);
  for (int i = 0; i < mesh.size(); ++i)
    for (int k = 0; k < components; ++k)
      u.row(i)[k] =
          *rc::gen::element(0.0, 1.0, 0.3) * std::pow(10.0, *rc::gen::element(0, -3, -20, -160, -305));
  return u;
}

inline double smallest(const apsis::field& u) {
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < u.cells(); ++i)
    lowest = std::min(lowest, *std::min_element(u.row(i), u.row(i) + u.components()));
  return lowest;
}

/// Returns cell averages or point values of g(x, k).
template <class Function>
apsis::field sample(const apsis::grid& mesh, int components, bool averages, Function g) {
  apsis::field u(mesh.size(), components);
  for (int i = 0; i < mesh.size(); ++i) {
    const double x = mesh.centre(i, 0), h = mesh.spacing(0);
    for (int k = 0; k < components; ++k) {
      if (!averages) {
        u.row(i)[k] = g(x, k);
        continue;
      }
      // Five-point Gauss quadrature on four parts of a cell is exact up to rounding for the smooth functions
      // of these tests.
      constexpr double node[3] = {0.0, 0.538469310105683091, 0.906179845938663993};
      constexpr double weight[3] = {0.568888888888888889, 0.478628670499366468, 0.236926885056189088};
      double sum = 0.0;
      for (int part = 0; part < 4; ++part) {
        const double centre = x + h * (part - 1.5) / 4.0, half = h / 8.0;
        for (int q = 0; q < 3; ++q)
          sum += weight[q] *
                 (q == 0 ? g(centre, k) : g(centre - half * node[q], k) + g(centre + half * node[q], k));
      }
      u.row(i)[k] = sum / 8.0;
    }
  }
  return u;
}

/// Returns T(u).
inline apsis::field transport_of(const apsis::transport& t, const apsis::field& u) {
  apsis::field result(u.cells(), u.components());
  const apsis::target<apsis::field, double> to{&result, 0.0, 1.0, true};
  t.add_transport(0.0, u, {&to, 1});
  return result;
}

inline double total(const apsis::relaxation_model& m, const apsis::field& u, int moment) {
  double sum = 0.0;
  std::vector<double> omega(static_cast<std::size_t>(m.moment_count()));
  for (int i = 0; i < u.cells(); ++i) {
    m.moments(u.row(i), omega.data());
    sum += omega[static_cast<std::size_t>(moment)];
  }
  return sum;
}
