#pragma once

#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/grid.hpp>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace apsis {

/// The parts of faces and cells of a mesh where a function φ is positive, in two or three dimensions. The
/// zero of φ on an edge is computed once, so that cells agree on the face between them.
class open_parts {
 public:
  using corner = std::array<int, 3>;  ///< corner number 0 … n of each direction

  open_parts(const grid& mesh, const outside_function& phi);

  /// The open part of a face, or of a cell.
  struct part {
    double share = 0.0;    ///< share of the size of the face or cell
    position middle = {};  ///< centroid of the open part
  };
  enum class state { open, closed, cut };

  /// Returns the state of a cell by the signs of φ at its corners.
  state of_cell(const corner& lowest) const;
  /// Returns the open part of the face that is normal to `direction` and has the lowest corner `lowest`.
  part face(int direction, const corner& lowest);
  /// Returns the corners of the open part of a face, counter-clockwise seen from the upper side; in two
  /// dimensions its ends.
  std::vector<position> corners_of_face(int direction, const corner& lowest);
  /// Returns the corners of a whole face in the same order.
  std::vector<position> corners_of_square(int direction, const corner& lowest) const;
  /// Returns the loops of the zeros of φ on the edges of a cell. They bound the wall in the cell, in the
  /// order of wall_segment::corners. Consecutive corners differ.
  std::vector<std::vector<position>> wall_loops(const corner& lowest);
  /// Returns the mean of the zeros of φ on the edges of a cut cell.
  position middle_of_zeros(const corner& lowest);
  /// The kind of a thin part between the corners of a cell.
  enum class thin_part { none, body, gap };
  struct thin_cell {
    thin_part part = thin_part::none;  ///< does not include the tip of a body that ends in the cell
    bool loses = false;  ///< whether a part of a body, including a tip, lies between the corners
  };
  /// Returns the thin parts of bodies that pass between the corners of a cell.
  thin_cell thin_in(const corner& lowest) const;
  /// Returns the share of a cell where φ ≤ 0, from 8 samples along each direction.
  double closed_share(const corner& lowest) const;
  /// Whether a surface may pass between the corners of a cell, according to φ at the corners and in
  /// the middle.
  bool may_be_thin(const corner& lowest) const;
  /// Throws input_error, because `something` near a cell is too thin for the mesh. The message
  /// suggests space.cells.
  [[noreturn]] void refuse_as_thin(const std::string& something, const corner& lowest) const;
  /// Returns the shortest stretch between two zeros of φ on lines through a cell, as a share of the cell.
  double thickness(const corner& lowest) const;

 private:
  struct plane {
    int first, second;  ///< directions in the plane
  };
  long number(const corner& at) const;
  double value(const corner& at) const { return values_[static_cast<std::size_t>(number(at))]; }
  bool is_open(const corner& at) const { return value(at) > 0.0; }
  position point(const corner& at) const;
  position point(const corner& at, const std::array<double, 3>& shift) const;
  double zero_on_edge(int direction, const corner& lower);
  double find_zero(int direction, const corner& lower) const;
  part open_edge(int direction, const corner& lower);
  part open_polygon(const plane& of, const corner& lowest);
  /// A corner of the open part of a square: a corner of the mesh, or a zero of φ on an edge.
  struct vertex {
    std::array<double, 2> share;  ///< along the directions of the square
    corner lower;                 ///< the corner, or the lower end of the edge
    int edge;                     ///< direction of the edge; −1 for a corner
  };
  struct polygon {
    std::array<vertex, 8> vertices = {};
    std::size_t count = 0;
  };
  using edge_key = std::pair<int, long>;  ///< direction of an edge and number of its lower corner
  /// Zeros on edges, each with the edge of the next zero along a wall.
  using zero_chain = std::map<edge_key, std::pair<vertex, edge_key>>;
  polygon open_vertices(const plane& of, const corner& lowest);
  position point_of(const vertex& of);
  void add_wall_sides(const plane& of, const corner& lowest, bool reversed, zero_chain& chain);
  /// Numbers of open and closed stretches of lines that reach neither of their ends.
  struct stretches {
    int gaps = 0, bodies = 0;
  };
  void count_stretches(const corner& lowest, const std::array<double, 3>& from, int direction,
                       stretches& found) const;
  thin_cell thin_in_square(const corner& lowest, const plane& of, const std::array<double, 3>& from) const;
  thin_part island_in(const corner& lowest) const;
  bool corners_are_connected(const corner& lowest) const;
  thin_part between_corners(const corner& lowest) const;
  void close_corners_on_surface();

  const grid& mesh_;
  const outside_function& phi_;
  corner corners_ = {1, 1, 1};
  std::vector<double> values_;                             ///< φ at each corner
  std::array<std::unordered_map<long, double>, 3> zeros_;  ///< on edges of a direction, by their lower corner
};

}  // namespace apsis
