#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <cstddef>

namespace apsis {
namespace {

/// Vacuum behind the face: what arrives leaves for ever, and nothing enters, f = 0 for v_n into the domain.
class vacuum_boundary final : public incoming_boundary {
 public:
  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    auto own = std::make_shared<vacuum_boundary>(*this);
    own->components_ = entering_components(where, velocities).size();
    return own;
  }

  void incoming(const face&, double, const position&, const double*, double* values) const override {
    std::fill_n(values, components_, 0.0);
  }

 private:
  std::size_t components_ = 0;
};

}  // namespace

extern const boundary_entry boundary_vacuum;
const boundary_entry boundary_vacuum = {
    .name = "vacuum",
    .description = "vacuum behind the face: particles leave, nothing enters",
    .make = [](const boundary_source& from) -> std::unique_ptr<boundary> {
      if (from.equation != nullptr && !from.equation->positive())
        throw input_error(
            "boundary 'vacuum' cannot be used (the components of the model are not densities of particles); "
            "choose another kind, see: apsis list boundaries");
      return std::make_unique<vacuum_boundary>();
    }};

}  // namespace apsis
