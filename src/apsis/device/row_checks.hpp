#pragma once

#include <apsis/device/device.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/mesh/grid.hpp>
#include <apsis/model/model.hpp>
#include <apsis/scheme/row_check.hpp>

#include <memory>
#include <vector>

namespace apsis {

/// Returns compute_squares() for all rows of two states on a device, with the same bits. Copies two numbers
/// of every cell to the host.
std::vector<row_squares> compute_squares(device& on, const field& u, const field& v);

/// Checks of all rows of a state on a device, with the same bits as on the host. Copies seven to nine numbers
/// of every cell to the host.
class device_row_checks {
 public:
  /// The checks of a row.
  struct row {
    row_extremes extremes;    ///< compute_extremes()
    const double* densities;  ///< model::invariant_densities()
    double entropy;           ///< entropy of a row without negative numbers, if the model has one
  };

  /// Returns the checks for the cells of a mesh that contain gas; null if there is no kernel for the model.
  /// `on` and `equation` must outlive the object.
  static std::unique_ptr<device_row_checks> make(device& on, const model& equation, const grid& mesh);
  virtual ~device_row_checks() = default;

  /// Checks all rows.
  virtual void evaluate(const field& u) = 0;
  /// Returns the checks of the row of a cell from the last evaluate(), which the next one overwrites.
  virtual row of(int cell) const = 0;
};

}  // namespace apsis
