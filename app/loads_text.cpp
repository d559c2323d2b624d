#include "loads_text.hpp"

#include <apsis/mesh/face.hpp>
#include <apsis/run/setup.hpp>

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace apsis::app {
namespace {

/// The largest of some fluxes, and the face of this flux.
struct largest_flux {
  double value = 0.0;
  std::string face = {};

  void look_at(double flux, const std::string& where) {
    if (std::abs(flux) > std::abs(value)) *this = {flux, where};
  }
  std::string text(const std::string& name) const {
    return face.empty() ? "" : fmt::format("  {} {:.5g} ({})", name, value, face);
  }
};

/// Whether a momentum is the component normal to a face, whose flux contains the pressure.
bool is_normal(const std::string& momentum, const std::string& where) {
  for (std::size_t k = 0; k < face_names.size(); ++k)
    if (face_names[k] == where) return momentum == "momentum" || momentum.back() == "xyz"[k / 2];
  return false;
}

}  // namespace

std::string loads_text(const simulation& now) {
  const run_setup& setup = now.setup();
  if (setup.equation->as_gas() == nullptr) return "";
  const auto faces = setup.open_faces(), names = setup.equation->invariants();
  largest_flux drag, heat;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f] == "force" || faces[f] == "source") continue;
    for (std::size_t k = 0; k < names.size() && f * names.size() + k < now.last().flux.size(); ++k) {
      const double flux = now.last().flux[f * names.size() + k];
      if (names[k] == "energy") heat.look_at(flux, faces[f]);
      if (names[k].starts_with("momentum") && !is_normal(names[k], faces[f])) drag.look_at(flux, faces[f]);
    }
  }
  return drag.text("drag") + heat.text("heat");
}

}  // namespace apsis::app
