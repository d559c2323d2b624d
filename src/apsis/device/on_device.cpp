#include <apsis/device/on_device.hpp>

#include <apsis/device/internal/device_collision.hpp>
#include <apsis/device/internal/device_transport.hpp>
#include <apsis/semidiscrete/discretization_registry.hpp>

#include <utility>

namespace apsis {
namespace {

class finite_differences_on_device final : public discretization {
 public:
  finite_differences_on_device(device& card, std::string reconstruction)
      : device_(card),
        host_(find_discretization("finite-difference").instance()),
        reconstruction_(std::move(reconstruction)) {}

  const cell_unknown& unknown() const override { return host_.unknown(); }
  collision_layout collisions_at(const std::string& place, const reconstruction& scheme) const override {
    return host_.collisions_at(place, scheme);
  }
  double limited_cfl_number(const std::string& place) const override {
    return host_.limited_cfl_number(place);
  }

  std::unique_ptr<transport> make_transport(const problem_parts& of) const override {
    using limits = limited_reconstruction::limits;
    const limits limited = of.limited && !of.first_order() ? limits::fluxes : limits::nothing;
    return std::make_unique<device_transport>(device_, of.equation, of.space,
                                              limited_reconstruction{of.scheme, limited}, unknown(),
                                              kernel_of_reconstruction(reconstruction_));
  }
  std::unique_ptr<collision> make_collision(const problem_parts& of) const override {
    return std::make_unique<device_collision>(device_, of.equation, of.epsilon_at(unknown().points()),
                                              of.keeps_sign(), of.space->mesh().fluid(), of.stages);
  }

 private:
  device& device_;
  const discretization& host_;
  std::string reconstruction_;
};

}  // namespace

std::shared_ptr<const discretization> on_device(device& card, const std::string& reconstruction) {
  return std::make_shared<finite_differences_on_device>(card, reconstruction);
}

}  // namespace apsis
