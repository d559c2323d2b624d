#pragma once

#include <apsis/core/index.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/internal/block_matrix.hpp>

#include <array>
#include <vector>

#include <Eigen/SparseCore>

namespace apsis {

/// Cells that follow each other along a direction, by their numbers among the cells of the gas. The first one
/// follows the last one on a line that is periodic.
using line_of_cells = std::vector<int>;

/// Returns the lines along a direction. Each cell of the gas is on one of them. `number`: of a cell among
/// those of the gas.
std::vector<line_of_cells> lines_along(const cell_links& links, int direction,
                                       const std::vector<int>& number);

/// The mesh, as a solver of moment equations sees it.
struct moment_mesh {
  int directions = 1,  ///< of the mesh
      moments = 1,     ///< of a cell
      cells = 0;       ///< of the gas
  /// Numbers of cells that are eliminated together, one after the other; all of them where it is empty.
  std::vector<int> parts = {};
  std::array<std::vector<line_of_cells>, 3> lines = {};
  std::vector<double> volumes = {};  ///< of cells relative to whole ones; all are whole where it is empty
  double extent = 1.0,               ///< the longest side of the domain
      spacing = 1.0;                 ///< the shortest side of a cell
  bool first_order = false;          ///< whether fluxes between cells are

  /// Returns the volume of a cell relative to a whole one.
  double volume(int number) const { return volumes.empty() ? 1.0 : volumes[at(number)]; }
  /// Returns the number of rows that cells have.
  int unknowns() const { return moments * cells; }
};

/// A sparse matrix that is stored by rows.
using row_matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The linearised moment equations J δω = r of a whole mesh, as sums of matrices with a block of
/// moments × moments for each pair of cells.
struct moment_equations {
  /// Without any term.
  explicit moment_equations(const moment_mesh& mesh);

  std::array<block_matrix, 3> along = {};  ///< ∂ω-derivatives of the fluxes along every direction
  block_matrix inside = {};                ///< those of forces and sources, and the pseudo-time term
  std::vector<int> conserved = {};         ///< moments whose sum is prescribed by an equation of its own
  /// Scales of J for wave numbers k of a cell, [number][moments²]: |k| flights + k² spreads.
  std::vector<double> flights = {}, spreads = {};
};

/// Returns J without the equations of sums.
row_matrix bare_matrix(const moment_mesh& mesh, const moment_equations& equations);

/// Returns J with a row and a column for each moment that is conserved: its sum over the volumes, divided by
/// the number of cells, and a source of it that is the same in all cells.
row_matrix bordered_matrix(const moment_mesh& mesh, const moment_equations& equations);

}  // namespace apsis
