#include <apsis/run/setup.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/expression.hpp>
#include <apsis/core/suggest.hpp>
#include <apsis/integrate/schedule.hpp>
#include <apsis/method/convexity.hpp>
#include <apsis/scheme/quartic.hpp>
#include <apsis/scheme/reconstruction_registry.hpp>
#include <apsis/semidiscrete/newton_collision.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <boost/math/quadrature/gauss.hpp>
#include <fmt/format.h>

namespace apsis {
namespace {

domain make_space(const case_config& config, bool has_space) {
  if (!has_space) return domain::point();
  const grid mesh = grid::line(config.space.cells, config.space.domain[0], config.space.domain[1]);
  return {mesh, {make_boundaries(config)}};
}

/// An input error at the place of a key, as far as that is known.
[[noreturn]] void refuse(const case_config& config, const std::string& key, const std::string& message) {
  const auto place = config.places.find(key);
  if (place == config.places.end()) throw input_error(message);
  throw input_error(place->second, message);
}

/// Smallest and largest value of every macroscopic field.
std::pair<std::vector<double>, std::vector<double>> extremes_of_fields(const model& equation,
                                                                       const field& u) {
  std::vector<double> values(equation.fields().size());
  std::vector<double> lowest(values.size(), std::numeric_limits<double>::infinity()), highest(values.size());
  for (double& value : highest) value = -std::numeric_limits<double>::infinity();
  for (int cell = 0; cell < u.cells(); ++cell) {
    equation.macroscopic(u.row(cell), values.data());
    for (std::size_t k = 0; k < values.size(); ++k) {
      lowest[k] = std::min(lowest[k], values[k]);
      highest[k] = std::max(highest[k], values[k]);
    }
  }
  return {lowest, highest};
}

struct interval {
  double centre, half;
};

/// The cell cut at the jumps that lie in it; the cell itself where there are none. A jump on an edge, up to
/// rounding, cuts nothing.
std::vector<interval> smooth_parts(const std::vector<double>& jumps, double centre, double half) {
  std::vector<double> ends = {centre - half};
  for (const double jump : jumps)  // in increasing order
    if (std::abs(jump - centre) < (1.0 - 1e-9) * half) ends.push_back(jump);
  if (ends.size() == 1) return {{centre, half}};
  ends.push_back(centre + half);
  std::vector<interval> parts;
  for (std::size_t k = 1; k < ends.size(); ++k)
    parts.push_back({0.5 * (ends[k - 1] + ends[k]), 0.5 * (ends[k] - ends[k - 1])});
  return parts;
}

}  // namespace

run_setup::run_setup(const case_config& config)
    : equation(make_model(config)),
      config_(config),
      space_(std::make_shared<domain>(make_space(config, has_space()))) {
  method_ = &find_method(config.time.method);
  check_method();
  if (has_space()) choose_stencil();
}

void run_setup::check_method() {
  const bool transports = has_space() || equation->has_source();
  if (method_->kind == method_kind::implicit_only && transports)
    refuse(config_, "time.method",
           fmt::format("method '{}' cannot integrate model '{}' (it is implicit only and the model has "
                       "transport); choose an IMEX or explicit method",
                       method_->name, config_.model.name));
  const auto form = method_->coefficients<double>();
  ssp_coefficient_ = is_convex(form, method_->kind, form.stages()) ? form.r : 0.0;
  if (config_.time.safety && ssp_coefficient_ == 0.0)
    refuse(config_, "time.safety",
           fmt::format("time.safety needs a method with an SSP coefficient (that of '{}' is 0); give time.dt "
                       "or time.cfl",
                       method_->name));
  check_startup();
  check_tolerance();
}

void run_setup::check_startup() const {
  if (!has_graded_start()) return;
  if (method_->kind == method_kind::explicit_only)
    refuse(
        config_, "time.startup",
        fmt::format("time.startup = \"graded\" has no meaning for method '{}' (it is explicit: steps that do "
                    "not resolve the layer are unstable later too); remove it or choose an IMEX method",
                    method_->name));
  if (dynamic_cast<const relaxation_model*>(equation.get()) == nullptr)
    refuse(config_, "time.startup",
           fmt::format("time.startup = \"graded\" has no meaning for model '{}' (its relaxation time is not "
                       "known); remove it",
                       config_.model.name));
}

void run_setup::check_tolerance() const {
  if (!has_tolerance()) return;
  // The estimate is a difference of two numbers of double precision, relative to them.
  constexpr double finest = 64.0 * std::numeric_limits<double>::epsilon();
  if (*config_.time.tolerance < finest)
    refuse(config_, "time.tolerance",
           fmt::format(
               "time.tolerance = {:g} cannot be kept (the rounding of an estimate is of this size); give "
               "at least {:.2g}",
               *config_.time.tolerance, finest));
  try {
    require_embedded_row(*method_);
  } catch (const input_error& missing) {
    refuse(config_, "time.tolerance", std::string("time.tolerance cannot be kept: ") + missing.what());
  }
}

void run_setup::choose_stencil() {
  const reconstruction_entry* scheme = find_reconstruction(config_.space.reconstruction);
  if (scheme == nullptr) throw input_error("unknown reconstruction '" + config_.space.reconstruction + "'");
  how_.scheme = scheme->make();
  if (config_.space.limiter == "positivity" && !equation->positive())
    refuse(config_, "space.limiter",
           fmt::format("space.limiter = \"positivity\" cannot be used with model '{}' (its unknowns may be "
                       "negative); write \"none\"",
                       config_.model.name));
  if (config_.space.limiter == "positivity" && !first_order())
    how_.positivity =
        config_.space.formulation == formulation::finite_volume ? limiter_kind::edges : limiter_kind::fluxes;
  const int needed = 2 * how_.scheme->ghost_width() + 1;
  if (config_.space.cells < needed)
    refuse(config_, "space.cells",
           fmt::format("space.cells = {} is smaller than the stencil ({} cells for {}); give at least {}",
                       config_.space.cells, needed, config_.space.reconstruction, needed));
}

bool run_setup::pointwise() const {
  return !has_space() || first_order() || config_.space.formulation == formulation::finite_difference;
}

std::vector<double> run_setup::centres() const {
  std::vector<double> x;
  for (int cell = 0; cell < mesh().size(); ++cell) x.push_back(has_space() ? mesh().centre(cell, 0) : 0.0);
  return x;
}

std::vector<double> run_setup::epsilon_on(const std::vector<double>& x) const {
  const auto place = config_.places.find("model.epsilon");
  const expression formula(config_.model.epsilon,
                           place == config_.places.end() ? source_place{} : place->second);
  std::vector<double> values;
  for (const double at : x) values.push_back(formula.evaluate(at));
  return values;
}

std::vector<double> run_setup::epsilon_at_centres() const {
  return epsilon_on(centres());
}

std::unique_ptr<semidiscrete_problem> run_setup::make_problem() const {
  std::unique_ptr<collision> q;
  if (const auto* general = dynamic_cast<const general_model*>(equation.get())) {
    q = make_newton_collision(*general);
  } else {
    const auto& relaxation = dynamic_cast<const relaxation_model&>(*equation);
    if (pointwise()) {
      q = make_pointwise_collision(relaxation, epsilon_at_centres(), keeps_sign());
    } else {
      std::vector<double> points;
      for (const double centre : centres())
        for (const double xi : gauss3::xi) points.push_back(centre + xi * mesh().spacing(0));
      q = make_cell_average_collision(relaxation, space_, how_, epsilon_on(points));
    }
  }
  auto problem = std::make_unique<semidiscrete_problem>(*equation, space_, how_, std::move(q));
  if (method_->kind == method_kind::explicit_only) problem->treat_collision_explicitly();
  return problem;
}

const initial_data& run_setup::data() const {
  const auto& all = equation->initial();
  const auto found = std::find_if(all.begin(), all.end(), [this](const auto& item) {
    return config_.model.initial.empty() || item.name == config_.model.initial;
  });
  if (found == all.end()) throw input_error("unknown initial data '" + config_.model.initial + "'");
  return *found;
}

field run_setup::sampled(const std::function<void(double, std::span<double>)>& point_value,
                         const std::vector<double>& jumps) const {
  field u(mesh().size(), equation->components());
  std::vector<double> values(static_cast<std::size_t>(u.components()));
  const bool averages = has_space() && config_.space.formulation == formulation::finite_volume;
  for (int cell = 0; cell < u.cells(); ++cell) {
    const double centre = mesh().centre(cell, 0), half = 0.5 * mesh().spacing(0);
    double* row = u.row(cell);
    const auto add = [&](double x, double weight) {
      point_value(x, values);
      for (std::size_t k = 0; k < values.size(); ++k) row[k] += weight * values[k];
    };
    if (averages) {
      // Ten points on every smooth part: exact to round-off for data that the mesh resolves at all.
      using rule = boost::math::quadrature::gauss<double, 10>;
      for (const auto& part : smooth_parts(jumps, centre, half)) {
        for (std::size_t q = 0; q < rule::abscissa().size(); ++q) {
          const double weight = part.half / half * 0.5 * rule::weights()[q];
          add(part.centre - part.half * rule::abscissa()[q], weight);
          add(part.centre + part.half * rule::abscissa()[q], weight);
        }
      }
    } else {
      add(has_space() ? centre : 0.0, 1.0);
    }
  }
  return u;
}

field run_setup::initial_state() const {
  field u = sampled(data().point_value, data().jumps);
  for (int cell = 0; cell < u.cells(); ++cell) {
    const misfit found = equation->unfit(u.row(cell));
    if (!found.problem.empty()) refuse(config_, found.key, fmt::format("{} [cell {}]", found.problem, cell));
  }
  const auto [lowest, highest] = extremes_of_fields(*equation, u);
  const misfit found = equation->unfit_range(lowest.data(), highest.data());
  if (!found.problem.empty()) refuse(config_, found.key, found.problem);
  return u;
}

std::optional<field> run_setup::exact_state(double t) const {
  const auto& exact = data().exact;
  if (!exact) return std::nullopt;
  return sampled([&exact, t](double x, std::span<double> u) { exact(t, x, u); }, {});
}

double run_setup::cfl_length() const {
  if (!has_space()) throw input_error("time.cfl needs a mesh (the model has no space); give time.dt");
  double fastest = config_.velocity.max;
  if (!(fastest > 0.0))
    for (const double v : equation->speeds(0)) fastest = std::max(fastest, std::abs(v));
  return mesh().spacing(0) / fastest;
}

double run_setup::equilibrium_defect(const field& u) const {
  const auto* relaxation = dynamic_cast<const relaxation_model*>(equation.get());
  if (relaxation == nullptr || equation->invariants().empty()) return 0.0;
  const std::size_t count = equation->invariants().size();
  std::vector<double> omega(static_cast<std::size_t>(relaxation->moment_count()));
  std::vector<double> e(static_cast<std::size_t>(u.components()));
  std::vector<double> before(count), after(count), scales(count), missed(count), all(count);
  for (int cell = 0; cell < u.cells(); ++cell) {
    relaxation->moments(u.row(cell), omega.data());
    if (!relaxation->equilibrium(omega.data(), e.data())) continue;  // the first step has a message
    equation->invariant_densities(u.row(cell), before.data());
    equation->invariant_densities(e.data(), after.data());
    equation->invariant_scales(before.data(), scales.data());
    for (std::size_t k = 0; k < count; ++k) {
      missed[k] += std::abs(after[k] - before[k]);
      all[k] += scales[k];
    }
  }
  double worst = 0.0;
  for (std::size_t k = 0; k < count; ++k)
    if (all[k] > 0.0) worst = std::max(worst, missed[k] / all[k]);
  return worst;
}

void run_setup::decide_promises(run_promises& promises, double dt, double limit, bool nonnegative,
                                bool exact_equilibrium) const {
  const bool within = ssp_coefficient_ > 0.0 && dt <= limit;
  // Through open ends mass and entropy come and go.
  const bool closed = space_->closed();
  // An explicit Q/epsilon beyond the step that it allows carries its rounding times dt/epsilon into the
  // invariants.
  const bool explicit_collision = schedule(method_->coefficients<double>()).collision_evaluations() > 0;
  promises.conservation =
      closed && exact_equilibrium && !equation->invariants().empty() && (within || !explicit_collision);
  promises.positivity = equation->positive() && nonnegative && within && keeps_sign();
  // An equilibrium with other moments is not the least entropy among the states with those of the data.
  promises.entropy =
      equation->has_entropy() && nonnegative && closed && within && first_order() && exact_equilibrium;
}

}  // namespace apsis
