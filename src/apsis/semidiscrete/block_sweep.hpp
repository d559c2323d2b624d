#pragma once

#include <apsis/exec/aligned.hpp>
#include <apsis/exec/profile.hpp>
#include <apsis/model/model.hpp>
#include <apsis/semidiscrete/face_fluxes.hpp>
#include <apsis/semidiscrete/sweep.hpp>
#include <apsis/semidiscrete/upwind_rows.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace apsis {

/// Speeds of the components along a direction, repeated for the cells that may be joined into one row.
struct line_speeds {
  aligned_vector<double> per_cell;     ///< |v|/Δx per component
  aligned_vector<double> forward;      ///< 1 if v > 0, else 0
  aligned_vector<double> inverse_cfl;  ///< 1/C of limited fluxes, C being a CFL number

  /// Returns the speeds along each direction of a mesh, without C.
  static std::vector<line_speeds> of(const model& equation, const grid& mesh);
  /// Returns Σ_k |v_k|/Δx_k of all components; empty without space.
  static aligned_vector<double> rates(const std::vector<line_speeds>& speeds);
  /// Sets C for forward Euler steps of `share` times the longest one, Δt = share κ/(max Σ_k
  /// |v_k|/Δx_k + κ a). Here a is the rate of a force. Each component gets C = Δt (Σ_k |v_k|/Δx_k +
  /// a), at least limiter::least_cfl_number.
  static void limit_for_steps(std::vector<line_speeds>& speeds, double share, double rate_of_force,
                              double kappa);
  /// Sets 1/C = limiter::steady_inverse_cfl() of each component.
  static void limit_for_steady_states(std::vector<line_speeds>& speeds, double collisions);
};

/// Computes T along one direction after the other, for some cells and some of their components. The rows of
/// the cells are looked up only once for all components. An object is the workspace of a single thread.
class block_sweep {
 public:
  /// The objects that all sweeps of a transport share.
  struct context {
    const model& equation;                   ///< equation
    const domain& space;                     ///< cells and ghost rows
    const limited_reconstruction& edges;     ///< edge values and limiter
    const std::vector<line_speeds>& speeds;  ///< speeds along each direction
    face_fluxes& faces;                      ///< receives the fluxes at surfaces
  };
  /// Consecutive cells of a segment.
  struct stretch {
    int direction;  ///< direction of the sweep
    int segment;    ///< number of the segment
    int begin;      ///< first cell, counted along the segment
    int end;        ///< one past the last cell
  };
  /// Targets of a sweep: acc ← (fresh ? 0 : acc) + α u + β T. Only the first direction adds α u.
  using targets_view = std::span<const target<field, double>>;

  /// Allocates buffers for stretches of `cells` cells and at most `width` components, in boxes
  /// of `cells_of_box` cells.
  void reserve(const context& of, int cells, int cells_of_box, int width, std::size_t targets);
  /// Discards all stretches. `of` and `u` must outlive the subsequent sweeps.
  void start(const context& of, const field& u);
  /// Looks up the rows of a stretch.
  void visit(const stretch& cells);
  /// Adds T of the components first … last − 1 to the targets, along each stretch in the order of the visits.
  /// Stores the upwind values at surfaces.
  void run(int first, int last, targets_view targets);

 private:
  /// A stretch with its first row.
  struct visited {
    stretch cells;
    std::array<int, 2> seen;  ///< cells of the halo before a surface that prescribes incoming values
    std::size_t first_row;
  };
  /// The part of the phase space that a sweep changes.
  struct place : stretch {
    int first, last;  ///< components
  };
  /// Separate cells, or cells that form a single "cell" for the kernels. The latter and their neighbours are
  /// contiguous in memory.
  struct run_of_cells {
    int cells, joined;
  };

  const segment_end* surface_at(bool upper, const place& at) const;
  int seen_beyond(bool upper, const stretch& at) const;
  int rows_of(const stretch& cells) const { return cells.end - cells.begin + 2 * (halo_ + reach_); }
  void sweep(const visited& one, int first, int last, targets_view targets);
  void empty(int cell);
  void record(const segment_end& end, bool upper, int joined);
  bool both_edges() const;
  kernel_work work_of(targets_view targets, int cells) const;
  void prepare(const visited& one, const place& at);
  void make_room(int cells, int width);
  const double* const* row(int i) const { return rows_.data() + (i - first_row_); }
  std::size_t offset(int i) const {
    return static_cast<std::size_t>(i - first_edge_) * static_cast<std::size_t>(width_);
  }
  run_of_cells run_from(int i, int most) const;
  void make_edges(int i, const run_of_cells& run);
  const double* source(int i, const run_of_cells& run);
  void add(int i, const run_of_cells& run, const place& at, targets_view targets, bool at_surface);

  const context* of_ = nullptr;
  const field* u_ = nullptr;
  std::vector<visited> visited_;
  std::vector<const double*> visited_rows_;  ///< rows of all stretches; null for rows that nothing reads
  std::vector<int> visited_joined_;          ///< number of contiguous rows from each one
  const segment* segment_ = nullptr;
  const line_speeds* line_ = nullptr;
  std::vector<const double*> rows_;  ///< rows of some components
  const int* joined_ = nullptr;      ///< contiguous rows from each one; null if rows are not joined
  std::vector<upwind::row_target> targets_;
  aligned_vector<double> left_, right_, source_, vacuum_, in_, out_;
  int width_ = 0, first_component_ = 0, halo_ = 0, reach_ = 0, first_row_ = 0, first_edge_ = 0;
  bool whole_rows_ = false;
  std::array<int, 2> seen_ = {};
};

/// Returns the memory traffic of the accumulators per number: a write, and a read unless they are fresh.
kernel_work traffic(block_sweep::targets_view targets);

}  // namespace apsis
