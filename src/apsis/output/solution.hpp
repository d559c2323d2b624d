#pragma once

#include <apsis/output/field_series.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace apsis {

/// The full state at the end of a run, as it is written to solution.h5. Dimensionless.
struct solution {
  std::string title;
  double t = 0.0;
  long step = 0;
  std::uint64_t cells = 0, components = 0;
  std::vector<double> f;           ///< [cells][components]
  std::vector<double> velocities;  ///< [components]; empty without a velocity grid
  std::vector<double> epsilon;     ///< [cells]; empty where the model has none
  field_series fields;             ///< the last snapshot is that of the end
};

/// Datasets f, v, x, epsilon, fields/<name>; with several snapshots also snapshots/t and snapshots/<name>
/// [snapshots][cells]. Every dataset has the attribute units = "dimensionless". Throws io_error.
void write_solution(const std::string& path, const solution& s);

/// The description of solution.h5 for ParaView and VisIt: f over (v, x), the fields over x.
std::string solution_xdmf(const solution& s);

}  // namespace apsis
