// Methods of one step whose stages solve the collision implicitly, or evaluate it.
#include <apsis/method/certificate.hpp>
#include <apsis/method/convexity.hpp>
#include <apsis/method/integrator_kind_registry.hpp>
#include <apsis/method/kinds/one_step.hpp>

#include <utility>

namespace apsis {
namespace runge_kutta_kind {
namespace {

/// Whether a stage needs Q of an earlier one whose solve does not yield it (d = 0 or ḋ ≠ 0).
bool evaluates_collisions(const shu_osher_form<double>& m) {
  for (std::size_t k = 0; k < m.stages(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      if (m.D(k, j) != 0.0 && !(m.D(j, j) != 0.0 && m.ddot[j] == 0.0)) return true;
  return false;
}

bool reads(const method& file) {
  return file.steps == 1 && !solves_exactly(file.kind);
}

std::unique_ptr<time_integrator> make(method file) {
  return std::make_unique<one_step_integrator>(std::move(file));
}

}  // namespace
}  // namespace runge_kutta_kind

one_step_integrator::one_step_integrator(method m) : method_(std::move(m)) {
  name = method_.name;
  title = method_.title;
  kind = "runge-kutta";
  order = method_.claims.order;
  stages = method_.stages();
  form = method_.coefficients<double>();
  if (is_convex(form, method_.kind, form.stages())) ssp_coefficient = form.r;
  needs.explicit_collision = runge_kutta_kind::evaluates_collisions(form);
  needs.exact_collision = solves_exactly(method_.kind);
}

integrator_certificate one_step_integrator::certify() const {
  const certificate c = apsis::certify(method_);
  integrator_certificate out;
  out.facts = {{"kind", to_string(method_.kind)},
               {"steps", steps},
               {"order", c.order},
               {"ssp_coefficient", c.ssp_coefficient.convert_to<double>()},
               {"explicit_evaluations", c.explicit_evaluations},
               {"implicit_solves", c.implicit_solves}};
  out.failures = c.failures;
  return out;
}

extern const integrator_kind_entry integrator_kind_runge_kutta;
const integrator_kind_entry integrator_kind_runge_kutta = {
    .name = "runge-kutta",
    .description = "stages of one step, each an explicit sum and an implicit solve of the collision",
    .reads = runge_kutta_kind::reads,
    .of_file = runge_kutta_kind::make};

}  // namespace apsis
