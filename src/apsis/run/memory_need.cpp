#include <apsis/run/memory_need.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/exec/memory.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/phase/field.hpp>

#include <cmath>

#include <fmt/format.h>

namespace apsis {
namespace {

int buffers_of(const run_setup& setup) {
  const method& m = setup.integrator();
  const int compared = setup.config().time.steady ? 1 : 0;
  return compared + (setup.has_tolerance()
                         ? schedule(m.with_embedded_row().coefficients<double>(), true).buffers()
                         : schedule(m.coefficients<double>()).buffers());
}

std::string in_units(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

}  // namespace

void check_memory(const case_config& config, const run_setup& setup, int copies) {
  const double cells = setup.has_space() ? make_mesh(config).size() : 1.0;
  const int components = setup.equation->components(), buffers = buffers_of(setup);
  const double state = cells * sizeof(double);
  const double snapshots = 1.0 + (config.output.every > 0.0 ? config.time.end / config.output.every : 0.0);
  const auto fields = static_cast<double>(config.output.fields.empty() ? setup.equation->fields().size()
                                                                       : config.output.fields.size());
  const double needed =
      state * (buffers * field::padded(components) + copies * components + snapshots * fields);
  const memory_limit limit = available_memory();
  if (needed <= limit.bytes) return;
  const std::string message = fmt::format(
      "the run needs at least {} of memory and {} are left ({:.0f} cells x {} unknowns in {} buffers of "
      "method "
      "'{}', {} copies for results, {:.0f} snapshots of the fields; {}); use fewer cells or velocities",
      in_units(needed), in_units(limit.bytes), cells, components, buffers, setup.integrator().name, copies,
      snapshots, limit.source);
  const auto place = config.places.find("space.cells");
  if (place == config.places.end()) throw input_error(message);
  throw input_error(place->second, message);
}

}  // namespace apsis
