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

/// Speeds of the components along a direction, for as many cells as are joined into one row.
struct line_speeds {
  aligned_vector<double> per_cell;     ///< |v|/Δx per component
  aligned_vector<double> forward;      ///< 1 if v > 0, else 0
  aligned_vector<double> inverse_cfl;  ///< 1/C of limited fluxes

  /// Returns the speeds along each direction of a mesh, without C.
  static std::vector<line_speeds> of(const model& equation, const grid& mesh);
  /// Returns Σ_k |v_k|/Δx_k of all components; empty without space.
  static aligned_vector<double> rates(const std::vector<line_speeds>& speeds);
  /// Sets C for forward Euler steps of `share` times the longest, Δt = share κ/(max Σ_k |v_k|/Δx_k + κ a):
  /// C = Δt (Σ_k |v_k|/Δx_k + a) of each component, limiter::least_cfl_number at least, with the rate a of a
  /// force.
  static void limit_for_steps(std::vector<line_speeds>& speeds, double share, double rate_of_force,
                              double kappa);
};

/// T along one direction after the other, for some cells and some of their components. The rows of the cells
/// are looked up once for all components. A workspace of one thread.
class block_sweep {
 public:
  /// The objects that all sweeps of a transport share.
  struct context {
    const model& equation;                   ///< equation
    const domain& space;                     ///< cells and ghost rows
    const limited_reconstruction& edges;     ///< edge values and limiter
    const std::vector<line_speeds>& speeds;  ///< of each direction
    face_fluxes& faces;                      ///< takes the fluxes at surfaces
  };
  /// Cells of a segment, along which a sweep goes.
  struct stretch {
    int direction;  ///< of the sweep
    int segment;    ///< number of the segment
    int begin;      ///< first cell of the segment
    int end;        ///< one past its last cell
  };
  /// Targets of a sweep: acc ← (fresh ? 0 : acc) + α u + β T, α u with the first direction alone.
  using targets_view = std::span<const target<field, double>>;

  /// Allocates buffers for stretches of `cells` cells and at most `width` components, in boxes of so many
  /// cells.
  void reserve(const context& of, int cells, int cells_of_box, int width, std::size_t targets);
  /// Forgets all stretches. `of` and `u` must outlive the sweeps that follow.
  void start(const context& of, const field& u);
  /// Looks up the rows of a stretch.
  void visit(const stretch& cells);
  /// Adds T of the components first … last − 1 to the targets, along each stretch in the order of the visits.
  /// Surfaces at the ends get their upwind values.
  void run(int first, int last, targets_view targets);

 private:
  /// A stretch, and the first of its rows.
  struct visited {
    stretch cells;
    std::array<int, 2> seen;  ///< cells of the halo before a surface that prescribes what enters
    std::size_t first_row;
  };
  /// The part of the phase space that a sweep changes.
  struct place : stretch {
    int first, last;  ///< components
  };
  /// Either separate cells, or cells that are contiguous in memory, as are their neighbours, and form a
  /// single "cell" for the kernels.
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
  std::vector<const double*> visited_rows_;  ///< of all stretches; null where nothing is read
  std::vector<int> visited_joined_;          ///< rows from each on that are contiguous in memory
  const segment* segment_ = nullptr;
  const line_speeds* line_ = nullptr;
  std::vector<const double*> rows_;  ///< of some components
  const int* joined_ = nullptr;      ///< of each row; null where rows are not joined
  std::vector<upwind::row_target> targets_;
  aligned_vector<double> left_, right_, source_, vacuum_, in_, out_;
  int width_ = 0, first_component_ = 0, halo_ = 0, reach_ = 0, first_row_ = 0, first_edge_ = 0;
  bool whole_rows_ = false;
  std::array<int, 2> seen_ = {};
};

/// Returns the memory traffic of the accumulators per number: a write, and a read unless they are fresh.
kernel_work traffic(block_sweep::targets_view targets);

}  // namespace apsis
