#include <apsis/study/limit_scheme.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/method/method.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/study/limit_space.hpp>

#include <algorithm>
#include <utility>

namespace apsis {
namespace {

const relaxation_model& relaxation_of(const run_setup& setup) {
  const auto* equation = setup.equation->as_relaxation();
  if (equation == nullptr)
    throw input_error(
        "the model has no limit scheme (its collision is not a relaxation towards E(ω)); choose a relaxation "
        "model");
  return *equation;
}

const method& imex_method(const std::string& name) {
  const method& m = find_method(name);
  if (m.kind != method_kind::imex)
    throw input_error("method '" + name +
                      "' has no limit scheme (it is not an IMEX method); choose an IMEX method");
  return m;
}

void add(field& sum, double factor, const field& x) {
  if (factor == 0.0) return;
  for (int i = 0; i < sum.cells(); ++i)
    for (int k = 0; k < sum.components(); ++k) sum.row(i)[k] += factor * x.row(i)[k];
}

std::vector<double> contiguous(const field& u) {
  std::vector<double> values;
  for (int i = 0; i < u.cells(); ++i) values.insert(values.end(), u.row(i), u.row(i) + u.components());
  return values;
}

}  // namespace

struct limit_scheme::impl {
  explicit impl(const case_config& config)
      : setup(config),
        equation(relaxation_of(setup)),
        space(config, equation),
        butcher(to_butcher(imex_method(config.time.method).coefficients<double>())),
        stages(butcher.stages()) {}

  bool relaxed(std::size_t j) const { return butcher.A(j, j) != 0.0 || butcher.A_dot(j, j) != 0.0; }

  /// Returns the factor κ_ij with which the change of stage j by relaxation enters the explicit
  /// part of stage i > j.
  double kept(std::size_t i, std::size_t j) const {
    if (butcher.A_dot(j, j) != 0.0) return butcher.A_dot(i, j) / butcher.A_dot(j, j);
    return butcher.A(j, j) != 0.0 ? butcher.A(i, j) / butcher.A(j, j) : 0.0;
  }

  bool used(std::size_t j) const {
    for (std::size_t i = j + 1; i < stages; ++i)
      if (butcher.A_hat(i, j) != 0.0) return true;
    return false;
  }

  /// Performs a step of the explicit method on the moments.
  void step_moments(double dt) {
    std::vector<field> slopes(stages);
    field stage;
    for (std::size_t i = 0; i < stages; ++i) {
      stage = state;
      for (std::size_t j = 0; j < i; ++j)
        if (used(j)) add(stage, dt * butcher.A_hat(i, j), slopes[j]);
      if (used(i)) slopes[i] = space.moments(space.transport(space.equilibria(stage)));
    }
    state = std::move(stage);
  }

  void step_averages(double dt) {
    std::vector<field> slopes(stages), moved(stages);
    field stage;
    for (std::size_t i = 0; i < stages; ++i) {
      stage = state;
      for (std::size_t j = 0; j < i; ++j) {
        if (used(j)) add(stage, dt * butcher.A_hat(i, j), slopes[j]);
        if (relaxed(j)) add(stage, kept(i, j), moved[j]);
      }
      if (relaxed(i)) {
        moved[i] = space.equilibrium_averages(stage);
        std::swap(stage, moved[i]);
        for (int c = 0; c < stage.cells(); ++c)
          for (int k = 0; k < stage.components(); ++k)
            moved[i].row(c)[k] = stage.row(c)[k] - moved[i].row(c)[k];
      }
      if (used(i)) slopes[i] = space.transport(stage);
    }
    state = std::move(stage);
  }

  field load(std::span<const double> u) const {
    field loaded(space.cells(), equation.components());
    const auto width = static_cast<std::size_t>(equation.components());
    if (u.size() != static_cast<std::size_t>(space.cells()) * width)
      throw input_error("the state has another size than the case; give [cells][components] values");
    for (int i = 0; i < loaded.cells(); ++i)
      std::copy_n(u.data() + static_cast<std::size_t>(i) * width, width, loaded.row(i));
    return loaded;
  }

  run_setup setup;
  const relaxation_model& equation;
  limit_space space;
  butcher_form<double> butcher;
  std::size_t stages;
  field state;  ///< ω, or the averages u
};

limit_scheme::limit_scheme(const case_config& config) : impl_(std::make_unique<impl>(config)) {}
limit_scheme::~limit_scheme() = default;
limit_scheme::limit_scheme(limit_scheme&&) noexcept = default;
limit_scheme& limit_scheme::operator=(limit_scheme&&) noexcept = default;

void limit_scheme::limit_for_steps(double share) {
  impl_->space.limit_for_steps(share);
}

void limit_scheme::start(std::span<const double> u) {
  impl_->state = impl_->load(u);
  if (!impl_->space.averages()) impl_->state = impl_->space.moments(impl_->state);
}

void limit_scheme::step(double dt) {
  impl_->space.averages() ? impl_->step_averages(dt) : impl_->step_moments(dt);
}

std::vector<double> limit_scheme::moments() const {
  const limit_space& space = impl_->space;
  return contiguous(space.averages() ? space.moments(impl_->state) : impl_->state);
}

std::vector<double> limit_scheme::equilibrium() const {
  const limit_space& space = impl_->space;
  if (!space.averages()) return contiguous(space.equilibria(impl_->state));
  return contiguous(impl_->relaxed(impl_->stages - 1) ? impl_->state
                                                      : space.equilibrium_averages(impl_->state));
}

std::vector<double> limit_scheme::moments_of(std::span<const double> u) const {
  return contiguous(impl_->space.moments(impl_->load(u)));
}

std::vector<double> limit_scheme::equilibrium_of(std::span<const double> u) const {
  const limit_space& space = impl_->space;
  const field loaded = impl_->load(u);
  return contiguous(space.averages() ? space.equilibrium_averages(loaded)
                                     : space.equilibria(space.moments(loaded)));
}

bool limit_scheme::relaxes_first_stage() const {
  return impl_->relaxed(0);
}

}  // namespace apsis
