#pragma once

#include <apsis/config/case.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/velocity/velocity_set.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace apsis {

/// The initial data of the table [initial]: a row at every point of space. Thread-safe.
class prescribed_data {
 public:
  /// Returns the place of a key of the case, such as "initial.region.1.T".
  using places = std::function<source_place(const std::string& path)>;

  /// u ← the row at x.
  using row_function = std::function<void(const position& x, std::span<double> u)>;

  /// Compiles the formulas of a case with a table [initial]. `equation`, its model, must outlive this
  /// object. `below` is the state below all regions if the case does not give it
  /// (initial_table::given_elsewhere). Throws input_error if a formula cannot be read, or if variables are
  /// unknown, missing, or of the wrong size.
  prescribed_data(const case_config& config, const model& equation, const places& place_of,
                  row_function below = {});
  ~prescribed_data();
  prescribed_data(prescribed_data&&) noexcept;  ///< the source can then only be destroyed

  /// u ← the row at x. Throws input_error with the place of a formula whose value is not finite, or of a
  /// state that has no row (ρ ≤ 0, T ≤ 0).
  void operator()(const position& x, std::span<double> u) const;

  /// Returns the ends of regions on a line in increasing order, exact to the last bit; empty in several
  /// dimensions. Regions thinner than about a sixtieth of a cell may be missed. Throws input_error if a
  /// region contains no point of the mesh.
  std::vector<double> jumps(const grid& mesh) const;

 private:
  class compiler;
  struct formula;
  struct state;
  struct region;
  /// Appends the value of a formula at x, or its values at x and all velocities.
  void append(const formula& of, const position& x, std::vector<double>& numbers) const;
  std::unique_ptr<state> base_;
  row_function below_;  ///< in place of `base_`, if it is set
  std::vector<region> regions_;
  int dimensions_ = 0;
  velocity_set velocities_;
};

}  // namespace apsis
