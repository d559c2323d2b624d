#include <apsis/config/limiter_of_case.hpp>

#include <apsis/config/discretization_of_case.hpp>
#include <apsis/core/errors.hpp>
#include <apsis/method/time_integrator.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>

namespace apsis {
namespace {

/// Returns whether the method has an SSP coefficient. The run refuses a file that is no
/// method, with its place.
bool has_ssp_coefficient(const std::string& method) {
  try {
    return find_integrator(method).ssp_coefficient > 0.0;
  } catch (const input_error&) {
    return false;
  }
}

}  // namespace

limiter_choice default_limiter(const case_config& config) {
  if (config.steady_state.tolerance) return limiter_choice::none;
  const auto equation = make_model(config);
  if (equation->space_dimensions() == 0 || !equation->positive() || !equation->collisions_keep_sign() ||
      !equation->why_signed().empty())
    return limiter_choice::none;
  const reconstruction_entry* scheme = try_find_reconstruction(config.space.reconstruction);
  if (scheme == nullptr || scheme->make()->order() == 1) return limiter_choice::none;
  const bool free = discretization_of(config).limited_cfl_number(config.space.collisions.value_or("")) == 1.0;
  return free && has_ssp_coefficient(config.time.method) ? limiter_choice::positivity : limiter_choice::none;
}

}  // namespace apsis
