#include <apsis/model/model_registry.hpp>

#include <limits>

namespace apsis {

std::span<const double> model::speeds(int) const {
  return {};
}

void model::source(const double*, double* s) const {
  for (int k = 0; k < components(); ++k) s[k] = 0.0;
}

double model::entropy(const double*) const {
  return std::numeric_limits<double>::quiet_NaN();
}

misfit model::unfit(const double*) const {
  return {};
}

misfit model::unfit_range(const double*, const double*) const {
  return {};
}

model_config default_config(const model_entry& entry) {
  model_config config;
  for (const auto& p : entry.parameters) config.parameters[p.name] = p.value;
  for (const auto& t : entry.texts) config.texts[t.name] = t.value;
  return config;
}

const model_entry* find_model(const std::string& name) {
  for (const model_entry* entry : model_entries())
    if (entry->name == name) return entry;
  return nullptr;
}

}  // namespace apsis
