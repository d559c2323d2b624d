#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/core/index.hpp>
#include <apsis/model/model.hpp>
#include <apsis/steady/cell_jacobian.hpp>
#include <apsis/steady/cell_links.hpp>
#include <apsis/steady/cut_links.hpp>
#include <apsis/steady/internal/moment_equations.hpp>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// Assembles the moment equations of a whole mesh from the derivatives of its cells.
class moment_assembly {
 public:
  /// All references must outlive the object. `first_order` is true if the fluxes of J are of first order.
  moment_assembly(const relaxation_model& equation, const domain& space, const inside_domain& acts,
                  const jacobian_layout& layout, bool first_order);

  const moment_mesh& mesh() const { return mesh_; }
  const std::vector<int>& cells() const { return links_.cells(); }  ///< cells of the gas
  /// Returns the number of a cell among those of the gas. The numbers are an order of elimination
  /// with little fill.
  int number(int cell) const { return number_[at(cell)]; }
  /// Returns J from the blocks of all cells, [cell][layout.numbers()], with `pseudo_rate` added
  /// to its diagonal.
  moment_equations assemble(std::span<const double> blocks, double pseudo_rate) const;

 private:
  /// Adds factor · block to the block at a row and a column of cells of the gas.
  void add_block(int row, int column, double factor, const double* block, block_matrix& to) const;
  void add_faces(std::span<const double> blocks, int direction, block_matrix& to) const;
  void add_cut_cells(std::span<const double> blocks, block_matrix& to) const;
  void add_face_of_cut(std::span<const double> blocks, int face, block_matrix& to) const;
  void add_walls(std::span<const double> blocks, const group_of_cut& of, block_matrix& to) const;
  std::vector<std::pair<int, double>> line_of_cut(int group, const std::array<double, 3>& to) const;
  void add_forces(block_matrix& to) const;
  void add_rotation(std::span<const double> blocks, block_matrix& to) const;
  std::vector<std::pair<int, double>> radial_gradient(int cell) const;
  void find_conserved(moment_equations& all) const;
  void add_scales(std::span<const double> blocks, moment_equations& all) const;
  /// Sets number_, and returns the mesh with these numbers.
  moment_mesh number_cells();
  const double* block_of(std::span<const double> blocks, int cell, std::size_t place) const {
    return blocks.data() + at(cell) * at(layout_.numbers()) + place;
  }

  const relaxation_model& equation_;
  const domain& space_;
  const inside_domain& acts_;
  jacobian_layout layout_;
  cell_links links_;
  cut_links cut_;
  bool first_order_;
  int count_;
  std::vector<int> number_;
  moment_mesh mesh_;
};

}  // namespace apsis
