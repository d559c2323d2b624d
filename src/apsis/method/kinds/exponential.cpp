// Methods of one step with exact collisions, files with kind = "exponential".
#include <apsis/method/integrator_kind_registry.hpp>
#include <apsis/method/kinds/one_step.hpp>

#include <utility>

namespace apsis {
namespace exponential_kind {
namespace {

class exponential_integrator final : public one_step_integrator {
 public:
  explicit exponential_integrator(method m) : one_step_integrator(std::move(m)) { kind = "exponential"; }
};

bool reads(const method& file) {
  return file.steps == 1 && solves_exactly(file.kind);
}

std::unique_ptr<time_integrator> make(method file) {
  return std::make_unique<exponential_integrator>(std::move(file));
}

}  // namespace
}  // namespace exponential_kind

extern const integrator_kind_entry integrator_kind_exponential;
const integrator_kind_entry integrator_kind_exponential = {
    .name = "exponential",
    .description = "stages of one step, each an explicit sum and an exact solution of the collision",
    .reads = exponential_kind::reads,
    .of_file = exponential_kind::make};

}  // namespace apsis
