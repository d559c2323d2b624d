#pragma once

#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/model/model_registry.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/upwind_transport.hpp>

#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <support/tested_device.hpp>

/// A flow whose operators a test makes on the host and on a device.
struct device_case {
  std::string label;                                                ///< names the case in messages
  std::unique_ptr<apsis::model> equation;                           ///< model of the gas
  apsis::grid mesh;                                                 ///< mesh
  std::vector<apsis::domain::faces> sides = {};                     ///< boundaries of each direction
  std::vector<std::shared_ptr<const apsis::boundary>> solids = {};  ///< boundaries of each solid box

  /// Returns a new domain. Each operator needs its own, because it fills the ghost rows.
  std::shared_ptr<apsis::domain> space() const {
    return std::make_shared<apsis::domain>(apsis::phase_space(mesh, equation->velocities()), sides, solids);
  }
};

/// Returns rows near a Maxwellian, with `jumps` also zeros and very small numbers.
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

/// Counts the numbers whose bits differ between device and host. It compares like its count.
struct bit_differences {
  int count = 0;
  std::string first = {};  ///< place and both numbers of the first difference

  bool operator==(int expected) const { return count == expected; }
  bit_differences& operator+=(const bit_differences& more) {
    if (count == 0) first = more.first;
    count += more.count;
    return *this;
  }
  /// Compares two numbers. The first pair that differs is recorded with its place.
  template <class Place>
  void compare(double host, double device, const Place& place) {
    if (std::memcmp(&host, &device, sizeof host) == 0) return;
    if (count++ == 0) first = fmt::format("{}: {:a} on the host, {:a} on the device", place(), host, device);
  }
  friend std::ostream& operator<<(std::ostream& to, const bit_differences& of) {
    return to << of.count << " numbers differ" << (of.count > 0 ? ", the first one in " + of.first : "");
  }
};

/// Compares a field of the host with a copy from a device, in the cells of the gas.
inline bit_differences different_numbers(const apsis::grid& mesh, const apsis::field& host,
                                         const apsis::field& copy) {
  auto cells = mesh.fluid();
  if (cells.empty()) cells.push_back({0, mesh.size()});
  bit_differences found;
  for (const auto& [begin, end] : cells)
    for (int i = begin; i < end; ++i)
      for (int k = 0; k < host.components(); ++k)
        found.compare(host.row(i)[k], copy.row(i)[k],
                      [&] { return fmt::format("cell {}, component {}", i, k); });
  return found;
}
