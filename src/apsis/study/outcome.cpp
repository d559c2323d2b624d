#include <apsis/study/outcome.hpp>

#include <apsis/model/model_registry.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <numeric>

namespace apsis {

outcome compute_outcome(const case_config& config, const study_control& control) {
  simulation run(config);
  while (!run.finished()) {
    control.check();
    run.advance();
  }
  outcome out;
  out.config = run.config();
  out.summary = run.summary();
  out.fields = run.fields();
  out.cells = run.mesh().size();
  out.components = run.setup().equation->components();
  out.state = run.state();
  out.exact = run.exact_state();
  if (run.setup().has_space()) out.cell_volume = make_mesh(config).cell_volume();
  // Weight of a uniform velocity grid, otherwise the mean weight. Velocities of other models
  // have no part in norms.
  if (find_model(config.model.name).has_velocity_grid) {
    const auto weights = run.setup().equation->velocities().weights();
    const bool equal =
        std::all_of(weights.begin(), weights.end(), [&](double w) { return w == weights.front(); });
    out.component_weight =
        equal ? weights.front()
              : std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
  }
  return out;
}

outcome compute_outcome(const std::string& name, const std::vector<std::string>& overrides,
                        const study_control& control) {
  return compute_outcome(load_case(name, overrides), control);
}

}  // namespace apsis
