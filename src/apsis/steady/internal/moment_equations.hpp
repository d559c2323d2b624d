#pragma once

#include <apsis/core/index.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/internal/block_matrix.hpp>

#include <array>
#include <vector>

#include <Eigen/SparseCore>

namespace apsis {

/// Consecutive cells along a direction, as numbers among the cells of the gas. On a periodic line the first
/// cell follows the last one.
using line_of_cells = std::vector<int>;

/// Returns the lines along a direction. Each cell of the gas is on one of them. number[cell] is the number of
/// a cell among those of the gas.
std::vector<line_of_cells> lines_along(const cell_links& links, int direction,
                                       const std::vector<int>& number);

/// The data of a mesh that a solver of moment equations needs.
struct moment_mesh {
  int directions = 1,  ///< directions of the mesh
      moments = 1,     ///< moments of a cell
      cells = 0;       ///< cells of the gas
  /// Numbers of cells that are eliminated together, in order; empty if all cells are eliminated together.
  std::vector<int> parts = {};
  std::array<std::vector<line_of_cells>, 3> lines = {};
  std::vector<double> volumes = {};  ///< volumes of cells relative to whole ones; empty if all are whole
  double extent = 1.0,               ///< the longest side of the domain
      spacing = 1.0;                 ///< the shortest side of a cell
  bool first_order = false;          ///< whether fluxes between cells are of first order

  /// Returns the volume of a cell relative to a whole one.
  double volume(int number) const { return volumes.empty() ? 1.0 : volumes[at(number)]; }
  /// Returns the number of rows for all cells.
  int unknowns() const { return moments * cells; }
};

/// A sparse matrix that is stored by rows.
using row_matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The linearised moment equations J δω = r of a whole mesh, as sums of matrices with a block of
/// moments × moments for each pair of cells.
struct moment_equations {
  /// Starts without any term.
  explicit moment_equations(const moment_mesh& mesh);

  std::array<block_matrix, 3> along = {};  ///< ∂/∂ω of the fluxes along every direction
  block_matrix inside = {};                ///< ∂/∂ω of forces and sources, and the pseudo-time term
  std::vector<int> conserved = {};         ///< moments with an equation for their sum
  /// Scales of J for wave numbers k of a cell, [number][moments²]: |k| flights + k² spreads.
  std::vector<double> flights = {}, spreads = {};
};

/// Returns J without the equations of sums.
row_matrix bare_matrix(const moment_mesh& mesh, const moment_equations& equations);

/// Returns J with an additional row and column for each conserved moment. The row is the sum over the
/// volumes, divided by the number of cells. The column is a source of the moment that is equal in all cells.
row_matrix bordered_matrix(const moment_mesh& mesh, const moment_equations& equations);

}  // namespace apsis
