#pragma once

#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/internal/open_parts.hpp>

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace apsis {

/// Cuts the cells of a mesh, for cut_cells.
class mesh_cutter {
 public:
  mesh_cutter(const grid& mesh, const std::vector<outside_function>& bodies,
              const std::array<bool, 3>& periodic, cut_cells& result);
  void cut();

 private:
  enum class kind : signed char { whole, cut, body, box };
  /// A piece of wall of a cell, in the coordinates of the cell.
  struct piece {
    int solid;
    std::array<double, 3> vector;  ///< area × normal
    position middle;
    std::vector<position> corners;
    std::array<double, 3> moment = {};  ///< ∫ (x − middle) × n dA
  };
  /// The gas of a cell that is cut, or that has joined a cut cell.
  struct gas_of_cell {
    double volume = 0.0;
    position centre = {};
    std::vector<piece> walls = {};
  };
  /// The open part of a face of a cell. `neighbour` is −1 at a face of the domain.
  struct way_out {
    int direction;
    bool upper;
    int neighbour;
    double area;
    position middle;  ///< in the coordinates of the cell
  };

  /// A neighbouring group by its root, and the direction of the largest face towards it.
  struct candidate {
    int cell, direction;
  };

  double outside(const position& x) const;
  int body_at(const position& x) const;
  open_parts::corner lowest_corner(int cell) const;
  int neighbour(int cell, int direction, bool upper) const;
  bool is_gas(int cell) const { return kinds_[at(cell)] == kind::whole || kinds_[at(cell)] == kind::cut; }

  open_parts::part open_face_of(int cell, int direction, bool upper);
  double share_of(int cell, int direction, bool upper) { return open_face_of(cell, direction, upper).share; }
  void check_periodic_faces();
  void sort_cells();
  void check_thin_cells(const std::vector<int>& thin, std::size_t of_bodies) const;
  void check_bodies() const;
  double volume_of_body(int cell) const;
  void check_lost_volume(const std::vector<int>& losing) const;
  gas_of_cell measured(int cell);
  void add_cut_cell(int cell);
  bool is_whole(int cell);
  bool is_like_whole(int cell);
  void check_closed_faces(int cell);
  void make_cut(int cell);
  void add_walls(int cell, gas_of_cell& to);
  std::vector<position> corners_of_wall(int cell, const position& middle,
                                        const std::array<double, 3>& vector);
  std::vector<position> corners_of_closed(int cell, int direction, bool upper, bool open_part);
  position on_surface(position from, const std::array<double, 3>& normal) const;
  std::vector<way_out> ways_out(int cell);

  void join();
  int root(int cell);
  void unite(int a, int b);
  std::map<int, std::vector<int>> members();
  double outflow(const std::vector<int>& cells);
  std::vector<candidate> best_neighbours(const std::vector<int>& cells);
  static void break_chains(std::map<int, std::vector<candidate>>& wanted);

  void number_groups();
  void find_centre(int group);
  void add_faces(int group);

  const grid& mesh_;
  const std::vector<outside_function>& bodies_;
  std::array<bool, 3> periodic_;
  cut_cells& result_;
  outside_function phi_;
  open_parts parts_;
  std::vector<kind> kinds_;
  std::map<int, gas_of_cell> gas_;
  std::vector<int> parents_;             ///< parents of joined cells; −1 for roots
  std::map<int, position> shifts_ = {};  ///< shift from the coordinates of a cell to those of its group
};

}  // namespace apsis
