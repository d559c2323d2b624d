#include <apsis/run/memory_need.hpp>

#include <apsis/boundary/domain.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/exec/memory.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/mesh/cut_cells.hpp>
#include <apsis/mesh/field.hpp>
#include <apsis/model/model.hpp>
#include <apsis/steady/macroscopic_system.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace apsis {
namespace {

constexpr int fewest_points = 4;  ///< smallest number suggested for velocity.points

/// Returns the number of fields of steady_iterations: the state, the first state, the residual, a temporary
/// field, the images of the mixture, and a source.
int buffers_of_iterations(const case_config& config) {
  return 4 + config.steady_state.images + (config.source_term.empty() ? 0 : 1);
}

int buffers_of(const run_setup& setup) {
  if (setup.config().steady_state.tolerance) return buffers_of_iterations(setup.config());
  const method& m = setup.integrator().starter();
  const bool compares = setup.has_tolerance() && m.embedded.has_value();
  // A doubled step keeps the results of the single step and of the first half.
  const int of_doubling = setup.has_tolerance() && !compares ? 2 : 0;
  const int of_step = compares ? schedule(m.with_embedded_row().coefficients<double>(), true).buffers()
                               : apsis::buffers_of(setup.integrator()) + of_doubling;
  const int compared = setup.config().time.steady ? 1 : 0;
  const int changes = setup.builder().collisions().reach > 0 ? 1 : 0;
  const int source = setup.config().source_term.empty() ? 0 : 1;
  return compared + changes + source + of_step;
}

/// Returns the number of rows that a problem stores at the surfaces of its mesh: ghost rows, values of both
/// sides at faces (face_fluxes), and slopes of cut cells.
double rows_at_surfaces(const run_setup& setup) {
  const domain& space = setup.builder().whole_space();
  const int width = setup.builder().ghost_rows();
  double rows = 0.0;
  for (int k = 0; const surface& one : space.surfaces()) {
    const bool may_prescribe =
        !one.segments.empty() && !space.is_border_of_cut_cells(k) && space.side(k)->prescribes_incoming(0, 1);
    rows += static_cast<double>(one.segments.size()) *
            ((space.repeats(k) ? 0 : width) + 1 + (may_prescribe ? 1 : 0));
    ++k;
  }
  if (const cut_cells* cut = space.mesh().cut())
    rows += static_cast<double>(cut->groups().size()) * space.mesh().dimensions();
  return rows;
}

std::string in_units(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", std::ceil(bytes / 1e3));
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

/// Returns the list as in a case file: "40" or "[16, 12]".
std::string as_value(const std::vector<int>& numbers) {
  return numbers.size() == 1 ? fmt::format("{}", numbers.front())
                             : fmt::format("[{}]", fmt::join(numbers, ", "));
}

double product(const std::vector<int>& numbers) {
  double all = 1.0;
  for (const int n : numbers) all *= n;
  return all;
}

/// Returns the numbers multiplied by a factor ≤ 1 and rounded down, but at least `lowest`.
std::vector<int> scaled(std::vector<int> numbers, double factor, int lowest) {
  for (int& n : numbers) n = std::max(lowest, static_cast<int>(std::floor(n * factor)));
  return numbers;
}

std::string advice(const memory_need& need, double limit) {
  std::vector<std::string> sizes;
  if (const auto cells = need.cells_that_fit(limit); !cells.empty())
    sizes.push_back("space.cells = " + as_value(cells));
  if (const auto points = need.points_that_fit(limit); !points.empty())
    sizes.push_back("velocity.points = " + as_value(points));
  return sizes.empty()
             ? "use fewer cells or velocities"
             : fmt::format("use fewer cells or velocities: {} would fit", fmt::join(sizes, ", or "));
}

}  // namespace

memory_need::memory_need(const run_setup& setup, int copies)
    : components_(setup.equation->components()),
      velocity_dimensions_(setup.equation->velocities().dimensions()),
      buffers_(buffers_of(setup)),
      copies_(copies * setup.integrator().steps),  // with earlier values
      method_(setup.integrator_name()) {
  const case_config& config = setup.config();
  const auto& output = config.output;
  snapshots_ = 1.0 + (output.every > 0.0 ? config.time.end / output.every : 0.0);
  fields_ = static_cast<double>(output.fields.empty() ? setup.equation->default_fields().size()
                                                      : output.fields.size());
  if (setup.has_space()) shape_ = config.space.cells;
  cells_ = product(shape_);
  if (shape_.size() > 1) rows_at_surfaces_ = rows_at_surfaces(setup);
  const auto& points = config.velocity.points;
  if (points > 0 && velocity_dimensions_ > 0) points_ = points.each();
  if (const relaxation_model* relaxes = setup.equation->as_relaxation();
      relaxes != nullptr && config.steady_state.tolerance && !shape_.empty())
    bytes_of_moments_ = macroscopic_system::bytes_of_cell(
        static_cast<int>(shape_.size()), relaxes->moment_count(), cells_, config.is_axisymmetric());
}

double memory_need::bytes(double cells, double components) const {
  const double padded = field::padded(static_cast<int>(std::min(components, 1e9)));
  constexpr double of_monitor = 2.0;  // step_differences
  // The rows at surfaces grow like the surface of a mesh of the same shape.
  const double dimensions = std::max(1.0, static_cast<double>(shape_.size())),
               at_surfaces = rows_at_surfaces_ * std::pow(cells / cells_, 1.0 - 1.0 / dimensions);
  return sizeof(double) * at_surfaces * padded +
         cells * (bytes_of_moments_ + sizeof(double) * (buffers_ * padded + copies_ * components +
                                                        snapshots_ * fields_ + of_monitor));
}

std::string memory_need::unknowns() const {
  const std::string of_cell = fmt::format("{:.0f} unknowns", components_);
  return shape_.empty() ? of_cell : fmt::format("{} cells x {}", fmt::join(shape_, " x "), of_cell);
}

std::string memory_need::text() const {
  return fmt::format("{} of memory ({})", in_units(bytes()), unknowns());
}

std::vector<int> memory_need::cells_that_fit(double limit) const {
  if (shape_.empty() || !(limit > 0.0)) return {};
  const auto scaled_by = [&](double factor) { return scaled(shape_, factor, 1); };
  const auto fits = [&](double factor) { return bytes(product(scaled_by(factor)), components_) <= limit; };
  if (fits(1.0)) return shape_;
  if (!fits(0.0)) return {};
  double factor = 0.0, above = 1.0;
  while (above - factor > 1e-9) (fits(0.5 * (factor + above)) ? factor : above) = 0.5 * (factor + above);
  return scaled_by(factor);
}

std::vector<int> memory_need::points_that_fit(double limit) const {
  if (points_.empty() || !(limit > 0.0)) return {};
  const double of_each = points_.size() > 1 ? 1.0 : velocity_dimensions_;
  const double sets = components_ / std::pow(product(points_), of_each);
  std::vector<int> best;
  // Memory is not linear in the number of components, because rows are padded.
  for (int most = *std::max_element(points_.begin(), points_.end()); most >= fewest_points; --most) {
    const double factor = static_cast<double>(most) / *std::max_element(points_.begin(), points_.end());
    best = scaled(points_, factor, fewest_points);
    if (bytes(cells_, sets * std::pow(product(best), of_each)) <= limit) return best;
  }
  return {};
}

/// The device has the states of a step and the rows at surfaces; the host has a copy of
/// the state for records.
void check_device_memory(const run_setup& setup) {
  const device* on = setup.runs_on();
  if (on == nullptr) return;
  const double free = static_cast<double>(on->free_bytes()), need = memory_need(setup, 0).bytes();
  if (need > free)
    throw io_error(
        fmt::format("the device {} has {} of free memory (the run needs about {}); use fewer space.cells or "
                    "velocity.points, or the host",
                    on->name(), in_units(free), in_units(need)));
}

void check_memory(const run_setup& setup, int copies) {
  const memory_need need(setup, copies);
  memory_limit limit = available_memory();
  // Memory of all machines, if they are like this one.
  const communicator& processes = setup.processes();
  limit.bytes *= 1.0 * processes.size() / processes.processes_here();
  if (need.bytes() <= limit.bytes) return;
  const std::string message = fmt::format("the run needs at least {}, and {} are left ({}); {}", need.text(),
                                          in_units(limit.bytes), limit.source, advice(need, limit.bytes));
  const auto& places = setup.config().places;
  const auto place = places.find("space.cells");
  if (place == places.end()) throw input_error(message);
  throw input_error(place->second, message);
}

}  // namespace apsis
