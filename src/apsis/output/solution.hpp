#pragma once

#include <apsis/output/field_series.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/phase/velocity_set.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace apsis {

/// The full state at the end of a run, as it is written to solution.h5. Dimensionless.
struct solution {
  std::string title;            ///< of the case
  std::string case_text;        ///< the resolved case as TOML
  std::string manifest;         ///< manifest.json
  double t = 0.0;               ///< time
  long step = 0;                ///< steps done
  std::uint64_t cells = 0,      ///< of the mesh; 1 without space
      components = 0;           ///< unknowns of a cell
  std::vector<double> f;        ///< [cells][components]; empty where it is not wanted
  velocity_set velocities;      ///< of the components; none without space
  std::vector<double> epsilon;  ///< [cells]; empty where the model has none
  field_series fields;          ///< the last snapshot is that of the end
};

/// Datasets f, v, x, epsilon, fields/NAME; with several snapshots also snapshots/t and snapshots/NAME
/// [snapshots][cells]. With two or three velocity dimensions v is [points][dimensions], and v_weights
/// [points] are added; where the velocities are a tensor product, also the nodes v_x, v_y, v_z and, with f,
/// its marginals/v_x, … [cells][nodes]. Every dataset has the attribute units = "dimensionless"; the file has
/// title, case (TOML) and manifest (JSON). Throws io_error.
void write_solution(const std::string& path, const solution& s);

/// The unknowns of one moment in a file of their own, of some of the cells.
struct distribution_snapshot {
  double t = 0.0;           ///< time
  long step = 0;            ///< steps done
  std::uint64_t cells = 0,  ///< that are written
      components = 0;       ///< unknowns of a cell
  std::vector<double> f;    ///< [cells][components]
  velocity_set velocities;  ///< of the components; none without space
  std::vector<double> x;    ///< [cells]; empty without space
};

/// Datasets f, v, x and what belongs to several velocity dimensions, as in solution.h5; attributes t and
/// step. Throws io_error.
void write_distribution(const std::string& path, const distribution_snapshot& s, precision stored);

/// One of the files that write_distribution wrote: its name beside solution.h5, and its time.
struct distribution_file {
  std::string name;                       ///< relative to the folder of solution.h5
  double t = 0.0;                         ///< time
  std::uint64_t cells = 0,                ///< rows of f
      components = 0;                     ///< columns of f
  bool has_axes = false;                  ///< the file has x and v
  precision stored = precision::float64;  ///< of f
};

/// The description of all of it for ParaView and VisIt: series in time of the fields over x, of f over (v, x)
/// or (v_y, v_x, x), and with several velocity dimensions of the marginals of f. Left out, with a comment: f
/// with three velocity dimensions, since there are no grids with four axes, and f on velocities that are no
/// grid.
std::string solution_xdmf(const solution& s, const std::vector<distribution_file>& distributions);

}  // namespace apsis
