#include <apsis/device/internal/device_source.hpp>

#include <apsis/device/internal/combined_rows.hpp>
#include <apsis/mesh/on_host.hpp>

#include <utility>

namespace apsis {

device_source::device_source(device& on, const model& equation, std::shared_ptr<domain> space,
                             source_rate rate, const cell_unknown& unknown)
    : device_(on),
      space_(std::move(space)),
      host_(equation, space_, std::move(rate), unknown),
      values_(space_->mesh().size(), equation.components(), on.memory()) {}

void device_source::add(double t, const field& u, std::span<const target<field, double>> targets) {
  if (host_.update(t, host_.depends_on_state() ? apsis::on_host(u, room_) : u))
    values_.copy_rows(host_.values());
  for (const auto& to : targets) {
    const linear_term<field, double> term{to.beta, &values_};
    combine_rows(device_, space_->mesh(), {&term, 1}, false, *to.acc);
  }
}

double device_source::growth(double t, const field& u) {
  return host_.growth(t, apsis::on_host(u, room_));
}

}  // namespace apsis
