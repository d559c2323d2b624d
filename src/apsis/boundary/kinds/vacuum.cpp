#include <apsis/boundary/boundary_registry.hpp>
#include <apsis/core/errors.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

namespace apsis {
namespace {

/// A wall with any normal that absorbs all arriving molecules and emits none.
class absorbing_wall final : public oblique_wall {
 public:
  explicit absorbing_wall(int components) : components_(components) {}

  void emit(const wall_point&, const double*, const double*, double* values) const override {
    std::fill_n(values, components_, 0.0);
  }

  std::array<double, 3> velocity(const wall_point&) const override { return {}; }

 private:
  int components_;
};

/// A vacuum behind the face: arriving molecules leave, and none enters, f = 0 for v_n into the domain.
class vacuum_boundary final : public incoming_boundary {
 public:
  std::shared_ptr<const boundary> prepared(const face& where, const velocity_set& velocities) const override {
    auto own = std::make_shared<vacuum_boundary>(*this);
    own->components_ = entering_components(where, velocities).size();
    return own;
  }

  std::shared_ptr<const oblique_wall> oblique(const velocity_set& velocities) const override {
    return std::make_shared<absorbing_wall>(velocities.components());
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
    },
    .any_normal = true};

}  // namespace apsis
