#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/device/teams.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/upwind_transport.hpp>

#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

/// A flow on a mesh of some dimensions, whose operators a test makes on the host and on a device.
struct device_case {
  std::string label;                                                ///< for messages
  std::unique_ptr<apsis::model> equation;                           ///< of the gas
  apsis::grid mesh;                                                 ///< its cells
  std::vector<apsis::domain::faces> sides = {};                     ///< of each direction
  std::vector<std::shared_ptr<const apsis::boundary>> solids = {};  ///< of each box

  /// A domain of its own for each operator: both fill its ghost rows.
  std::shared_ptr<apsis::domain> space() const {
    return std::make_shared<apsis::domain>(apsis::phase_space(mesh, equation->velocities()), sides, solids);
  }
};

/// Rows near a Maxwellian; with `jumps` also zeros and very small numbers.
inline apsis::field varied_rows(const apsis::grid& mesh, const apsis::model& equation, bool jumps) {
  const int components = equation.components();
  apsis::field u(mesh.size(), components);
  for (int i = 0; i < mesh.size(); ++i)
    for (int k = 0; k < components; ++k) {
      const apsis::position x = mesh.centre(i);
      const double wave =
          1.0 + (jumps ? 1.0 : 0.1) * std::sin(7.0 * x[0] + 5.0 * x[1] + 3.0 * x[2] + 0.3 * k);
      const int pattern = jumps ? (i * 31 + k * 17) % 23 : 6;
      double square = 0.0;
      for (int d = 0; d < mesh.dimensions(); ++d)
        square += std::pow(equation.speeds(d)[static_cast<std::size_t>(k)], 2);
      const double usual = wave * std::exp(-0.5 * square);
      u.row(i)[k] = pattern == 0   ? 0.0
                    : pattern == 1 ? 1e-280 * usual
                    : pattern == 2 ? 1e-300
                    : pattern < 6  ? 3.0 * usual
                                   : usual;
    }
  return u;
}

/// How many numbers have other bits in one of two fields of the host, in the cells of the gas.
inline int different_numbers(const apsis::grid& mesh, const apsis::field& a, const apsis::field& b) {
  auto cells = mesh.fluid();
  if (cells.empty()) cells.push_back({0, mesh.size()});
  int count = 0;
  for (const auto& [begin, end] : cells)
    for (int i = begin; i < end; ++i)
      for (int k = 0; k < a.components(); ++k)
        count += std::memcmp(a.row(i) + k, b.row(i) + k, 8) != 0 ? 1 : 0;
  return count;
}
