#pragma once

#include <apsis/output/field_series.hpp>
#include <apsis/output/hdf5_file.hpp>
#include <apsis/velocity/position.hpp>
#include <apsis/velocity/velocity_set.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace apsis {

/// The unknowns of chosen cells, the group "points" of a file.
struct distribution_at_points {
  std::vector<mesh_axis> centres;  ///< coordinates x, y, z of the cell centres, [points] each
  std::vector<double> f;           ///< [points][components]; empty if no cells are chosen
};

/// The wall of a body.
struct wall_outline {
  std::string name;  ///< name of the body
  /// [piece]: in the plane the two ends, the body on their left; in space the corners of a polygon,
  /// counter-clockwise seen from the gas.
  std::vector<std::vector<position>> corners;
  int dimensions = 2;  ///< dimensions of space

  /// Returns the shape of array(): pieces, the largest number of corners, dimensions.
  std::array<std::size_t, 3> shape() const;
  /// Returns the coordinates. Pieces with fewer corners repeat their last corner.
  std::vector<double> array() const;
};

/// The content of solution.h5: the state at the end of a run. If several processes share the mesh, f has the
/// cells of this process, and fields and epsilon have numbers on the root only. Numbers are dimensionless,
/// except for times and fields whose series has units. The cells are those of the axes of the fields.
struct solution {
  std::string title;                      ///< of the case
  std::string case_text;                  ///< the resolved case as TOML
  std::string manifest;                   ///< manifest.json
  double t = 0.0;                         ///< time
  long step = 0;                          ///< steps done
  std::uint64_t components = 0;           ///< unknowns of a cell
  std::vector<double> f;                  ///< [cells][components]; empty if not requested
  distribution_at_points points;          ///< f of chosen cells
  velocity_set velocities;                ///< velocities of the components; empty without space
  std::vector<double> epsilon;            ///< [cells]
  field_series fields;                    ///< the last snapshot is the final state
  std::vector<wall_outline> walls = {};   ///< walls of bodies, in units of the axes of the fields
  std::optional<dataset_part> part = {};  ///< part of the mesh of this process, if several share it
};

/// Writes solution.h5 with these datasets:
/// - f: [nx][components], [nx][ny][components] or [nx][ny][nz][components]
/// - epsilon, fields/NAME: [nx], [nx][ny] or [nx][ny][nz]
/// - x (and y, z): coordinates of the cell centres, one dataset for each axis of the mesh
/// - snapshots/t, snapshots/NAME: with several snapshots, like fields with [snapshots] first
/// - geometry/centres: with several axes, the points [nx][ny][nz][3] of the grids of solution.xdmf
/// - v: [points]; with two or three velocity dimensions [points][dimensions], and v_weights [points]
/// - v_x, v_y, v_z: nodes of several velocity dimensions, if the velocities are a tensor product
/// - marginals/v_x, …: with f and these nodes, like fields with [nodes] last
/// - walls/NAME: walls of bodies, [pieces][ends][2], in space [pieces][corners][3]
/// - points/f, points/x, …: chosen cells, f as [points][components]
///
/// Every dataset has the attribute units. The file has the attributes t, step, title, case (TOML) and
/// manifest (JSON). `processes` write the file together, each with its part; the texts are the same on
/// all. Throws io_error.
void write_solution(const std::string& path, const solution& s,
                    const std::shared_ptr<communicator>& processes = nullptr);

/// Writes only fields, with their coordinates as in solution.h5, and the attribute title. Throws io_error.
void write_fields(const std::string& path, const std::string& title, const field_series& fields);

/// The unknowns at one time, of all or some cells, for a file of their own.
struct distribution_snapshot {
  double t = 0.0;                         ///< time
  long step = 0;                          ///< steps done
  std::uint64_t components = 0;           ///< unknowns of a cell
  std::vector<mesh_axis> axes;            ///< of the cells written; empty without space
  std::vector<double> f;                  ///< [cells][components]; empty with `points`
  distribution_at_points points;          ///< f of chosen cells, in place of all
  velocity_set velocities;                ///< velocities of the components; empty without space
  std::optional<dataset_part> part = {};  ///< part of the written cells of this process, if there are several
};

/// Writes f, its marginals, x, y, z and the velocities as in solution.h5. For chosen cells it writes the
/// group points and the velocities instead. The attributes are t and step. Throws io_error.
void write_distribution(const std::string& path, const distribution_snapshot& s, precision stored,
                        const std::shared_ptr<communicator>& processes = nullptr);

/// A file written by write_distribution.
struct distribution_file {
  std::string name;                       ///< path relative to the folder of solution.h5
  double t = 0.0;                         ///< time
  std::vector<std::uint64_t> shape;       ///< cells along each axis
  precision stored = precision::float64;  ///< storage type of f
};

/// Returns the XDMF description for ParaView and VisIt. It has time series of the fields over x, and of f
/// over (v, x) or (v_y, v_x, x). With several velocity dimensions it also has those of the marginals of f.
/// With several axes of space the fields are on a structured grid, with vectors and symmetric tensors in
/// addition to their components. Functions of more than three coordinates are omitted, because grids have at
/// most three axes. So is f on velocities that are not a tensor product. A comment in the file says so.
std::string solution_xdmf(const solution& s, const std::vector<distribution_file>& distributions);

/// Returns the description of a file of write_fields() with several axes.
std::string fields_xdmf(const std::string& title, const field_series& fields, const std::string& file);

}  // namespace apsis
