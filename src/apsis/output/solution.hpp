#pragma once

#include <apsis/output/field_series.hpp>
#include <apsis/output/hdf5_file.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace apsis {

/// The full state at the end of a run, as it is written to solution.h5. Dimensionless.
struct solution {
  std::string title;
  std::string case_text;  ///< the resolved case as TOML
  std::string manifest;   ///< manifest.json
  double t = 0.0;
  long step = 0;
  std::uint64_t cells = 0, components = 0;
  std::vector<double> f;           ///< [cells][components]; empty where it is not wanted
  std::vector<double> velocities;  ///< [components]; empty without a velocity grid
  std::vector<double> epsilon;     ///< [cells]; empty where the model has none
  field_series fields;             ///< the last snapshot is that of the end
};

/// Datasets f, v, x, epsilon, fields/<name>; with several snapshots also snapshots/t and snapshots/<name>
/// [snapshots][cells]. Every dataset has the attribute units = "dimensionless"; the file has title, case
/// (TOML) and manifest (JSON). Throws io_error.
void write_solution(const std::string& path, const solution& s);

/// The unknowns of one moment in a file of their own, of some of the cells.
struct distribution_snapshot {
  double t = 0.0;
  long step = 0;
  std::uint64_t cells = 0, components = 0;
  std::vector<double> f;           ///< [cells][components]
  std::vector<double> velocities;  ///< [components]; empty without a velocity grid
  std::vector<double> x;           ///< [cells]; empty without space
};

/// Datasets f, v, x; attributes t and step. Throws io_error.
void write_distribution(const std::string& path, const distribution_snapshot& s, precision stored);

/// One of the files that write_distribution wrote: its name beside solution.h5, and its time.
struct distribution_file {
  std::string name;
  double t = 0.0;
  std::uint64_t cells = 0, components = 0;
  bool has_axes = false;  ///< x and v
  precision stored = precision::float64;
};

/// The description of all of it for ParaView and VisIt: series in time of the fields over x and of f over (v,
/// x).
std::string solution_xdmf(const solution& s, const std::vector<distribution_file>& distributions);

}  // namespace apsis
