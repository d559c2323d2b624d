#include <apsis/device/internal/device_transport.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/first_error.hpp>
#include <apsis/device/internal/combined_rows.hpp>
#include <apsis/device/internal/kernel_table.hpp>
#include <apsis/mesh/grid.hpp>

#include <algorithm>
#include <utility>

namespace apsis {
namespace {

using targets_view = std::span<const target<field, double>>;

}  // namespace

std::string kernel_of_reconstruction(const std::string& name) {
  std::string kernel = "sweep_" + name;
  std::replace(kernel.begin(), kernel.end(), '-', '_');
  for (const host_kernel& one : host_kernels())
    if (one.name == kernel) return kernel;
  throw input_error("the reconstruction \"" + name +
                    "\" is not possible on a device (its kernel is missing); use another one, or the host");
}

std::string device_transport::why_not(const model& equation, const limited_reconstruction& edges) {
  if (equation.space_dimensions() == 0) return "the model has no space";
  if (equation.has_source()) return "the model has a source";
  if (edges.limits_edges()) return "edge values are limited";
  return "";
}

device_transport::device_transport(device& on, const model& equation, std::shared_ptr<domain> space,
                                   limited_reconstruction edges, const cell_unknown& unknown,
                                   std::string kernel)
    : device_(on),
      equation_(equation),
      space_(std::move(space)),
      edges_(std::move(edges)),
      unknown_(unknown),
      kernel_(std::move(kernel)),
      host_(equation, space_, edges_, unknown),
      surfaces_(on, equation, space_, edges_),
      speeds_(line_speeds::of(equation, space_->mesh())) {
  if (const std::string reason = why_not(equation, edges_); !reason.empty())
    throw input_error("the run is not possible on a device (" + reason + "); run it on the host");
  for (int direction = 0; direction < space_->mesh().dimensions(); ++direction)
    along_.emplace_back(device_, *space_, surfaces_, direction, edges_.halo(), edges_.ghosts());
  limit_for_steps(1.0);
}

void device_transport::limit_for_steps(double share) {
  share_ = share;
  host_.limit_for_steps(share);
  const double of_force = force_ ? force_->on_host().rate() : 0.0;
  line_speeds::limit_for_steps(speeds_, share, of_force, cut_transport::kappa(edges_, space_->mesh()));
  for (std::size_t k = 0; k < along_.size(); ++k) along_[k].set_speeds(speeds_[k]);
  if (cut_transport* cut = surfaces_.in_cut_cells()) {
    const double step = share * forward_euler_step();
    cut->limit_for_steps(step,
                         aligned_vector<double>(line_speeds::rates(speeds_).size(), 1.0 - step * of_force));
  }
  if (force_) force_->on_host().limit_for_steps(share);
}

void device_transport::limit_for_steady_states(double collisions) {
  limit_for_steps(1.0);
  host_.limit_for_steady_states(collisions);
  line_speeds::limit_for_steady_states(speeds_, collisions);
  if (cut_transport* cut = surfaces_.in_cut_cells())
    cut->limit_for_steady_states(collisions, line_speeds::rates(speeds_));
  for (std::size_t k = 0; k < along_.size(); ++k) along_[k].set_speeds(speeds_[k]);
}

bool device_transport::add_transport(double t, const field& u, targets_view targets, const cells_job&) const {
  if (std::all_of(targets.begin(), targets.end(), [](const auto& to) { return to.beta == 0.0; })) {
    for (const auto& to : targets) {
      const linear_term<field, double> term{to.alpha, &u};
      combine_rows(device_, space_->mesh(), {&term, 1}, to.fresh, *to.acc);
    }
    return false;
  }
  first_error failure;
  failure.run([&] { sweep_all(t, u, targets); });
  if (force_ || source_) add_inside(t, u, targets, failure);
  failure.rethrow();
  return false;
}

/// Adds force and source. This is collective: the sums are over all processes, even if this one has failed.
void device_transport::add_inside(double t, const field& u, targets_view targets,
                                  first_error& failure) const {
  std::vector<double> given;
  const auto append = [&given](const std::vector<double>& more) {
    given.insert(given.end(), more.begin(), more.end());
  };
  if (force_) {
    failure.run([&] { force_->add(t, u, targets); });
    append(force_->on_host().given());
  }
  if (source_) {
    failure.run([&] { source_->add(t, u, targets); });
    append(source_->on_host().given());
  }
  if (force_) append(force_->on_host().losses());
  // Only the root accounts for the amount that all processes have received.
  if (!space_->processes().is_root()) std::fill(given.begin(), given.end(), 0.0);
  surfaces_.set_inside(given);
}

void device_transport::sweep_all(double t, const field& u, targets_view targets) const {
  first_error failure;
  failure.run([&] {
    surfaces_.fill(t, u);
    for (int direction = 0; direction < space_->mesh().dimensions(); ++direction)
      sweep(direction, u, targets);
    surfaces_.complete(t, targets);
  });
  // Other processes wait for the values at cut cells, even if a boundary of this process has failed.
  failure.run([&] { surfaces_.add_cut_cells(t, u, targets); });
  failure.rethrow();
}

void device_transport::sweep(int direction, const field& u, targets_view targets) const {
  constexpr auto most = static_cast<std::size_t>(kernels::sweep_arguments::most_targets);
  // Without targets the sweep only sets the rows at surfaces.
  std::size_t first = 0;
  do {
    const auto some = targets.subspan(first, std::min(most, targets.size() - first));
    kernels::sweep_arguments of{};
    of.u = u.row(0);
    of.sent = surfaces_.sent();
    of.at_ends = surfaces_.at_ends();
    of.stride = u.stride();
    of.limited = edges_.limits_fluxes() ? 1 : 0;
    of.targets = static_cast<int>(some.size());
    for (std::size_t k = 0; k < some.size(); ++k)
      of.target[k] = {some[k].acc->row(0), direction == 0 ? some[k].alpha : 0.0, some[k].beta,
                      direction == 0 && some[k].fresh ? 1 : 0};
    along_[static_cast<std::size_t>(direction)].sweep(kernel_, of);
    first += most;
  } while (first < targets.size());
}

void device_transport::combine(std::span<const linear_term<field, double>> terms, field& sum) const {
  if (terms.front().u == &sum && terms.front().alpha == 1.0)
    combine_rows(device_, space_->mesh(), terms.subspan(1), false, sum);
  else
    combine_rows(device_, space_->mesh(), terms, true, sum);
}

std::vector<double> device_transport::observe_surfaces(double t, const field& u) const {
  struct observation {
    surface_rows& of;
    explicit observation(surface_rows& rows) : of(rows) { of.observe(true); }
    ~observation() { of.observe(false); }
  } const watched(surfaces_);
  sweep_all(t, u, {});
  return surfaces_.observed();
}

void device_transport::set_force(acceleration of) {
  const gas_model* gas = equation_.as_gas();
  if (gas == nullptr || !device_gas_rows::why_not(gas->molecules()).empty())
    throw input_error(
        "a force is not possible on a device (its kernel has gases on products of velocity lines alone); run "
        "the case on the host");
  force_ = std::make_unique<device_force>(device_, *gas, space_, of, edges_);
  host_.set_force(std::move(of));
  limit_for_steps(share_);
}
void device_transport::set_rotation(int) {
  throw input_error(
      "axisymmetric flow is not possible on a device (its kernel is missing); run the case on the host");
}
void device_transport::set_source(source_rate rate) {
  source_ = std::make_unique<device_source>(device_, equation_, space_, std::move(rate), unknown_);
}

}  // namespace apsis
