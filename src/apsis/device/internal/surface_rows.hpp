#pragma once

#include <apsis/boundary/domain.hpp>
#include <apsis/device/device.hpp>
#include <apsis/device/internal/device_array.hpp>
#include <apsis/device/internal/device_cut_cells.hpp>
#include <apsis/semidiscrete/face_fluxes.hpp>
#include <apsis/semidiscrete/limited_reconstruction.hpp>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace apsis {

/// The surfaces and cut cells of a domain whose state is on a device. Before a sweep the host receives the
/// rows next to surfaces and those around cut cells, and its boundaries compute the ghost rows. After a sweep
/// it receives the upwind values at surfaces, and returns the incoming components and T of cut cells.
class surface_rows {
 public:
  /// `on` and `equation` must outlive the object.
  surface_rows(device& on, const model& equation, std::shared_ptr<domain> space,
               const limited_reconstruction& edges);

  /// Returns transport in cut cells on the host; null without bodies.
  cut_transport* in_cut_cells() { return cut_ ? &cut_->on_host() : nullptr; }

  /// Returns the number by which sweeps on the device find a row beyond an end of a segment (row_beyond).
  /// `distance` counts cells from the end; 0 is the nearest.
  int row_beyond_end(int direction, int segment, bool upper, int distance) const;
  /// Returns the number of the row that takes the upwind values at an end of a segment; −1 without a
  /// surface there.
  int row_at_end(int direction, int segment, bool upper) const;
  /// Returns the number of cells beyond an end on which fluxes depend, at most `halo`.
  int seen_beyond(int direction, int segment, bool upper, int halo) const;

  /// Computes the rows beyond all ends for a state on the device, and prepares the cut cells. Collective.
  void fill(double t, const field& u);
  /// Returns the rows beyond ends, on the device.
  const double* sent() const { return sent_.data(); }
  /// Returns the rows that sweeps set, on the device.
  double* at_ends() const { return at_ends_.data(); }
  /// Adds the incoming components to the targets; after all sweeps.
  void complete(double t, std::span<const target<field, double>> targets);
  /// Adds α u + β T to the targets in cut cells, after complete(). Collective.
  void add_cut_cells(double t, const field& u, std::span<const target<field, double>> targets) {
    if (cut_) cut_->add(t, mirror_, u, targets);
  }

  /// Calls face_fluxes::observe(), for complete().
  void observe(bool wanted) { faces_.observe(wanted); }
  /// Returns face_fluxes::observed().
  const std::vector<double>& observed() const { return faces_.observed(); }
  /// Calls face_fluxes::set_inside(), after complete().
  void set_inside(std::span<const double> given) { faces_.set_inside(given); }
  /// Returns face_fluxes::rates().
  std::span<const double> rates() const { return faces_.rates(); }

 private:
  /// Ends of segments at which components enter, for one direction and side; each cell has at most one.
  struct entries {
    double spacing = 1.0;
    std::vector<std::array<int, 3>> ends;  ///< in the layout of kernels::enter
    device_array<std::array<int, 3>> on_device;
  };

  void number_sent_rows();
  void list_rows_of_others();
  void list_inside_rows();
  void list_entries();
  std::vector<double> speeds_into(const face& where) const;
  const double* entering(int surface, int place, double t);

  device& device_;
  const model& equation_;
  std::shared_ptr<domain> space_;
  int ghosts_;  ///< rows beyond each end that a sweep reads
  face_fluxes faces_;
  std::unique_ptr<device_cut_cells> cut_;  ///< null without bodies
  field mirror_;                           ///< the rows next to surfaces, of all cells on the host
  std::vector<int> inside_;                ///< cells whose rows boundaries, cut cells or other processes read
  device_array<int> inside_on_device_;
  std::unordered_map<const double*, int> sent_numbers_;
  std::vector<const double*> sent_from_;  ///< rows beyond ends on the host
  std::vector<int> first_at_surface_;     ///< first row at the ends of each surface
  int ends_ = 0;
  std::vector<entries> entries_;
  std::vector<double> staged_;
  std::size_t stride_;
  mutable stored_numbers gathered_, sent_, at_ends_, entering_, inward_;
};

}  // namespace apsis
