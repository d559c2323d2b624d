#pragma once

#include <apsis/output/field_series.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/phase/velocity_set.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace apsis {

/// The content of solution.h5: the state at the end of a run. Dimensionless, except for times and fields
/// whose series has units.
struct solution {
  std::string title;            ///< of the case
  std::string case_text;        ///< the resolved case as TOML
  std::string manifest;         ///< manifest.json
  double t = 0.0;               ///< time
  long step = 0;                ///< steps done
  std::uint64_t cells = 0,      ///< of the mesh; 1 without space
      components = 0;           ///< unknowns of a cell
  std::vector<double> f;        ///< [cells][components]; empty if not requested
  velocity_set velocities;      ///< of the components; none without space
  std::vector<double> epsilon;  ///< [cells]
  field_series fields;          ///< the last snapshot is the final state
};

/// Writes the datasets f, v, x, epsilon, fields/NAME; with several snapshots also snapshots/t and
/// snapshots/NAME [snapshots][cells]. With two or three velocity dimensions v is [points][dimensions], and
/// v_weights [points] are added; where the velocities are a tensor product, also the nodes v_x, v_y, v_z and,
/// with f, its marginals/v_x, … [cells][nodes]. Every dataset has the attribute units; the
/// file has title, case (TOML) and manifest (JSON). Throws io_error.
void write_solution(const std::string& path, const solution& s);

/// The unknowns at one time, of all or some cells, for a file of their own.
struct distribution_snapshot {
  double t = 0.0;           ///< time
  long step = 0;            ///< steps done
  std::uint64_t cells = 0,  ///< cells written
      components = 0;       ///< unknowns of a cell
  std::vector<double> f;    ///< [cells][components]
  velocity_set velocities;  ///< of the components; none without space
  std::vector<double> x;    ///< [cells]; empty without space
};

/// Writes the datasets f, v, x and those of several velocity dimensions as in solution.h5, with attributes t
/// and step. Throws io_error.
void write_distribution(const std::string& path, const distribution_snapshot& s, precision stored);

/// A file written by write_distribution.
struct distribution_file {
  std::string name;                       ///< path relative to the folder of solution.h5
  double t = 0.0;                         ///< time
  std::uint64_t cells = 0,                ///< rows of f
      components = 0;                     ///< columns of f
  bool has_axes = false;                  ///< whether the file has x and v
  precision stored = precision::float64;  ///< storage type of f
};

/// Returns the XDMF description for ParaView and VisIt: time series of the fields over x, of f over (v, x) or
/// (v_y, v_x, x), and of the marginals of f with several velocity dimensions. Omitted, with a comment in the
/// file: f with three velocity dimensions, since grids have at most three axes, and f on velocities that are
/// not a tensor product.
std::string solution_xdmf(const solution& s, const std::vector<distribution_file>& distributions);

}  // namespace apsis
