#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/boundary/oblique_wall.hpp>
#include <apsis/exec/aligned.hpp>
#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/problem.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/cut_rows.hpp>
#include <apsis/semidiscrete/face_fluxes.hpp>
#include <apsis/semidiscrete/limited_reconstruction.hpp>
#include <apsis/semidiscrete/local_groups.hpp>
#include <apsis/semidiscrete/transport.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace apsis {

/// Transport in cut cells, by fluxes between linear functions ("lines"). A cut cell i with the volume V_i of
/// gas and the centroid x_i has the line
///     f_i + ϑ g·(x − x_i).
/// A least-squares fit to the neighbours behind open faces gives g (weights 1/distance²). The limiter ϑ ≤
/// 1 of each velocity ensures that at most f_i leaves in a step. With a limiter, leaving values are cut
/// at 0. Then
///     T_i = (1/V_i) (Σ_faces |v·e| a (f_up) in − out + Σ_walls A v·n f_w).
/// Here f_up is the line of the upwind group at the middle of the open face, or the limited edge value
/// of a whole cell. The normal n of a wall points into the gas. There f_w is the line for v·n < 0, and
/// the emission of the wall for v·n > 0. Both sides of a face use the same value, so that the
/// invariants are conserved.
///
/// Values remain nonnegative within Δt_FE: at most f_i leaves, and nonnegative values enter.
class cut_transport {
 public:
  /// `equation` and `faces` must outlive the object. Throws input_error if a boundary of a body does not
  /// support all normals.
  cut_transport(const model& equation, std::shared_ptr<domain> space, const limited_reconstruction& edges,
                face_fluxes& faces);

  /// Returns κ of transport on a mesh: limited_reconstruction::kappa(), at most cut_cells::cfl_number with
  /// bodies.
  static double kappa(const limited_reconstruction& edges, const grid& mesh) {
    return mesh.cut() != nullptr ? std::min(edges.kappa(), cut_cells::cfl_number) : edges.kappa();
  }

  /// Evaluates lines at walls in the plane half-way between the corners of their pieces, instead of at a
  /// point of the body. The flux of a linear function through the surface of a cell is then exact to
  /// rounding. In axisymmetric flow a uniform gas is such a function.
  void use_chords();
  /// Prepares for steps of at most this length. In such a step transport may take the fraction `kept` of a
  /// value of each component.
  void limit_for_steps(double step, aligned_vector<double> kept);
  /// Limits for a steady state instead, with 1/κ of limiter::steady_inverse_cfl(). `rates` are those at which
  /// each component leaves a whole cell, and `collisions` is the slowest rate of collisions.
  void limit_for_steady_states(double collisions, aligned_vector<double> rates);
  /// Returns the cells of this process with rows that evaluations of T read.
  std::vector<int> cells_read() const;
  /// Computes the lines from u. Collective.
  void prepare(const field& u);
  /// Returns the values that enter a whole cell from a cut cell, at an end of a segment. They are valid until
  /// the next call on this thread.
  const double* entering(int surface, int place, const field& u);
  /// Adds the flux of these values to the whole cell. Concurrent calls must differ in the cell at the end.
  void complete(int surface, int place, const field& u, std::span<const target<field, double>> targets);
  /// Receives T of a group of cut cells. `cells` are those of this process.
  using receiver = std::function<void(const std::vector<int>& cells, const double* rate)>;
  /// Computes T(t, u) of all groups of cut cells after the whole cells are complete. Collective. Concurrent
  /// calls of `receive` differ in the group.
  void evaluate(double t, const field& u, const receiver& receive);
  /// Adds T(t, u) to the cut cells after the whole cells are complete, and calls `then` for each
  /// cut cell. Collective.
  void add(double t, const field& u, std::span<const target<field, double>> targets, const cells_job& then);

 private:
  /// An open face of a group, or a piece of wall.
  struct way {
    enum class kind { group, whole, domain, wall } to;
    int number;                    ///< number of the group, border end, open face or wall; < 0: not here
    std::array<double, 3> normal,  ///< unit vector out of the gas at a face, into it at a wall
        from_centre,               ///< vector to its middle from the centroid
        from_other = {};           ///< vector to it from the centroid of the other group
    double rate = 0.0;             ///< area / volume; negative at a wall, so that both have the sign of v·n
    int surface = -1;              ///< surface of the border, or face of the domain; −1: another process
  };
  struct neighbour {
    int place;  ///< place of its row, as in local_groups
    std::array<double, 3> weight;
  };
  struct group {
    int place;               ///< place of its row, as in local_groups
    std::vector<int> cells;  ///< cells of this process; none if only its lines are needed
    std::vector<way> ways;
    std::vector<neighbour> around;
  };
  struct scratch {
    field rows;
    std::vector<cut_rows::neighbour> around;
    std::vector<cut_rows::outlet> outlets;
    std::vector<cut_rows::crossing> crossings;
    std::vector<double*> ghosts;      ///< rows beyond a face of the domain
    std::vector<const double*> seen;  ///< constant pointers to these rows
  };

  void find_walls();
  void find_places_at_border();
  void add_ways(int number);
  way way_through(int number, int face) const;
  int border_at(int direction, bool cut_is_below) const;
  void add_neighbours(int number);
  cut_rows::gradient slopes_of(int group);
  cut_rows::line line_of(const field& u, int group, const std::array<double, 3>& vector);
  cut_rows::line beyond(const field& u, const way& one);
  cut_rows::way_out out_by(const way& one) const { return {one.normal, one.rate, speeds_}; }
  cut_rows::extent size() const { return {directions(), equation_.components()}; }
  void fit_group(const field& u, int number, scratch& own);
  void receive_values_at_faces();
  template <class Receive>
  void evaluate_groups(double t, const field& u, const Receive& receive, int begin, int end);
  void add_group(double t, const field& u, int number, double* rate, scratch& own);
  void pass_end(double t, const way& one, const cut_rows::line& here, double* rate, scratch& own);
  void domain_values(double t, const way& one, double* values, scratch& own);
  const double* recorded_at(int face);
  void make_scratch();

  const cut_cells& cut() const { return *space_->mesh().cut(); }
  int directions() const { return space_->mesh().dimensions(); }

  const model& equation_;
  std::shared_ptr<domain> space_;
  face_fluxes& faces_;
  local_groups here_;
  bool flat_, limited_, steady_ = false;
  int ghosts_;
  double step_ = 0.0;
  aligned_vector<double> kept_;  ///< 1/κ − 1 for steady states
  std::array<const double*, 3> speeds_ = {};
  std::array<std::vector<double>, 6> inward_;               ///< speed away from each face of a cell
  std::vector<std::shared_ptr<const oblique_wall>> walls_;  ///< walls of boxes and bodies
  std::vector<group> groups_;                               ///< groups of local_groups::fitted()
  std::vector<int> number_of_;  ///< index in groups_ of each group of the mesh; −1 for others
  /// Place of the end of a segment at a cut cell, by surface and cell.
  std::map<std::pair<int, int>, int> places_;
  /// Group and way beyond each end at the border, [surface][place].
  struct border_end {
    int group = -1, way = -1;
  };
  std::vector<std::vector<border_end>> ends_;
  field slopes_;  ///< limited slopes, [group][direction]
  per_thread<scratch> scratch_;
};

}  // namespace apsis
