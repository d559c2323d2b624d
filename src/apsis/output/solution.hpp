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
  std::string name;  ///< of the body
  /// [piece]: in the plane the two ends, the body on their left; in space the corners of a polygon,
  /// counter-clockwise seen from the gas.
  std::vector<std::vector<position>> corners;
  int dimensions = 2;  ///< of space

  /// Returns the shape of array(): pieces, the largest number of corners, dimensions.
  std::array<std::size_t, 3> shape() const;
  /// Returns the coordinates. Pieces of fewer corners repeat their last one.
  std::vector<double> array() const;
};

/// The content of solution.h5: the state at the end of a run. On one of several processes f has the cells of
/// its part, and fields and epsilon have their numbers on the root only. Dimensionless, except for times and
/// fields whose series has units. Its cells are those of the axes of the fields.
struct solution {
  std::string title;                      ///< of the case
  std::string case_text;                  ///< the resolved case as TOML
  std::string manifest;                   ///< manifest.json
  double t = 0.0;                         ///< time
  long step = 0;                          ///< steps done
  std::uint64_t components = 0;           ///< unknowns of a cell
  std::vector<double> f;                  ///< [cells][components]; empty if not requested
  distribution_at_points points;          ///< f of chosen cells
  velocity_set velocities;                ///< of the components; none without space
  std::vector<double> epsilon;            ///< [cells]
  field_series fields;                    ///< the last snapshot is the final state
  std::vector<wall_outline> walls = {};   ///< of bodies, in units of the axes of the fields
  std::optional<dataset_part> part = {};  ///< of the mesh, of one of several processes
};

/// Writes the datasets f, v, epsilon, fields/NAME; the coordinates x (and y, z) of the cell centres, one
/// dataset for each axis of the mesh; with several snapshots also snapshots/t and snapshots/NAME. The shape
/// of a field is [nx], [nx][ny] or [nx][ny][nz]; f has [components] and snapshots have [snapshots] beside it.
/// With several axes geometry/centres [nx][ny][nz][3] are the points of the grids of solution.xdmf. With two
/// or three velocity dimensions v is [points][dimensions], and v_weights [points] are added; where the
/// velocities are a tensor product, also the nodes v_x, v_y, v_z and, with f, its marginals/v_x, … [nodes].
/// Walls of bodies are in walls/NAME [pieces][ends][2], in space [pieces][corners][3].
/// Chosen cells are in points/f [points][components], points/x, …. Every dataset has the attribute units; the
/// file has title, case (TOML) and manifest (JSON). Throws io_error. `processes`: those that write the file
/// together, each with its part; the texts are the same on all.
void write_solution(const std::string& path, const solution& s,
                    const std::shared_ptr<communicator>& processes = nullptr);

/// Writes fields alone with their coordinates, as in solution.h5, and the attribute title. Throws io_error.
void write_fields(const std::string& path, const std::string& title, const field_series& fields);

/// The unknowns at one time, of all or some cells, for a file of their own.
struct distribution_snapshot {
  double t = 0.0;                         ///< time
  long step = 0;                          ///< steps done
  std::uint64_t components = 0;           ///< unknowns of a cell
  std::vector<mesh_axis> axes;            ///< of the cells written; empty without space
  std::vector<double> f;                  ///< [cells][components]; empty with `points`
  distribution_at_points points;          ///< f of chosen cells, in place of all
  velocity_set velocities;                ///< of the components; none without space
  std::optional<dataset_part> part = {};  ///< of the cells written, of one of several processes
};

/// Writes the datasets f, v, x, y, z and those of several velocity dimensions, or of chosen cells the group
/// points, as in solution.h5, with attributes t and step. Throws io_error.
void write_distribution(const std::string& path, const distribution_snapshot& s, precision stored,
                        const std::shared_ptr<communicator>& processes = nullptr);

/// A file written by write_distribution.
struct distribution_file {
  std::string name;                       ///< path relative to the folder of solution.h5
  double t = 0.0;                         ///< time
  std::vector<std::uint64_t> shape;       ///< cells along each axis
  precision stored = precision::float64;  ///< storage type of f
};

/// Returns the XDMF description for ParaView and VisIt: time series of the fields over x, of f over (v, x) or
/// (v_y, v_x, x), and of the marginals of f with several velocity dimensions. With several axes of space the
/// fields are on a structured grid, with vectors and symmetric tensors in addition to their components.
/// Omitted, with a comment in the file: functions of more than three coordinates, since grids have at most
/// three axes, and f on velocities that are not a tensor product.
std::string solution_xdmf(const solution& s, const std::vector<distribution_file>& distributions);

/// Returns the description of a file of write_fields() with several axes.
std::string fields_xdmf(const std::string& title, const field_series& fields, const std::string& file);

}  // namespace apsis
