#include <apsis/study/profile_errors.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/graded_start.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/method/intermediate_regime.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace apsis {
namespace {

/// Returns the case on point values with the method of both solutions.
case_config reference_case(case_config config) {
  config.space.discretization = "finite-difference";
  config.time.method = "ars-443";
  config.time.startup = startup_choice::none;
  config.time.safety.reset();
  config.time.cfl.reset();
  config.time.steady.reset();
  config.time.dt = config.time.end;
  return config;
}

/// Returns the longest step of a run, without its start-up.
double step_of(case_config config) {
  if (config.time.tolerance)
    throw input_error(place_of(config, "time.tolerance"),
                      "a prediction needs a constant step (time.tolerance changes it); give time.dt and no "
                      "time.tolerance");
  config.time.startup = startup_choice::none;
  return simulation(config).dt();
}

/// Returns flux, last, layer and decay for any z, also that of a cell with ε = 0. Below 10⁻⁶
/// all are 1 up to O(z).
finite_rate<double> at_any_rate(const butcher_form<double>& b, double z) {
  if (z < 1e-6) return {1.0, 1.0, 1.0, 1.0 - z};
  const auto at = at_finite_rate(b, std::min(z, 1e12));
  if (!std::isfinite(at.flux) || !std::isfinite(at.layer))
    throw input_error(fmt::format(
        "the O(epsilon) terms cannot be predicted (flux(z) of the method is not finite at z = {:.3g}); "
        "choose another method",
        z));
  return at;
}

/// The steps of a run: `first` replaces the first one, and `further` steps of length dt follow.
struct step_sequence {
  std::vector<double> first;
  double dt;
  long further;

  /// Makes a graded start as a run with time.startup = "graded" does, if the relaxation time is positive.
  step_sequence(double end, double longest, double relaxation_time, int growth)
      : further(std::max(std::lround(std::ceil(end / longest * (1.0 - 1e-12))), 1L) - 1) {
    dt = end / static_cast<double>(further + 1);
    first = graded_start(dt, relaxation_time, growth);
  }
};

/// Returns ∫ D/D₀ dt of a deviation D in the initial layer, as the stages compute it. `rate` is C/ε.
double layer_in_stages(const butcher_form<double>& b, const step_sequence& steps, double rate) {
  double acts = 0.0, left = 1.0;
  for (const double dt : steps.first) {
    const auto at = at_any_rate(b, dt * rate);
    acts += dt * at.layer * left;
    left *= at.decay;
  }
  const auto at = at_any_rate(b, steps.dt * rate);
  const double lost = 1.0 - at.decay, further = static_cast<double>(steps.further);
  const double sum = lost == 0.0 ? further : (1.0 - std::pow(at.decay, further)) / lost;
  return acts + steps.dt * at.layer * left * sum;
}

/// Returns ∫ e^{−Ct/ε} dt from 0 to `end`.
double exact_layer(double rate, double end) {
  return rate > 0.0 ? -std::expm1(-rate * end) / rate : end;
}

/// A cell of the perturbed problem: its ε, and ∫ D/D₀ dt of the layer in addition to that of this ε.
struct perturbed_cell {
  double epsilon, layer;
};

/// The solution of a case and its response to a change of ε(x) and of the initial layer.
class response {
 public:
  response(const case_config& config, double longest_step, const study_control& control)
      : control_(control), setup_(reference_case(config)), end_(config.time.end), dt_(longest_step) {
    equation_ = setup_.equation->as_relaxation();
    if (equation_ == nullptr || equation_->relaxing_count() > 0 || !setup_.has_space() ||
        equation_->invariants().empty())
      throw input_error(
          place_of(config, "model.name"),
          fmt::format(
              "the O(epsilon) terms of model '{}' cannot be predicted (it has no space, or its target is "
              "no equilibrium of conserved moments); choose another model",
              config.model.name));
    start_ = setup_.initial_state();
    equilibrium_ = start_;
    with_epsilon([](const position&) { return 0.0; })->solve_collision(0.0, 1.0, 0.0, equilibrium_);
    epsilon_ = setup_.epsilon_at_centres();
    const auto problem = setup_.make_problem();
    relaxation_time_ = problem->relaxation_time(0.0, start_);
    first_rates_ = rates(start_);
    solution_ = solve(*problem, start_, &middle_rates_);
  }

  /// Returns the prediction for steps of length dt with the start-up of `config`.
  predicted_errors to(const butcher_form<double>& b, double dt, const case_config& config) const {
    const bool graded = config.time.startup == startup_choice::graded;
    const step_sequence steps(end_, dt, graded ? relaxation_time_ : 0.0, config.time.startup_growth);
    predicted_errors out;
    out.dt = steps.dt;
    std::vector<double> flux;
    for (const double rate : middle_rates_) flux.push_back(at_any_rate(b, steps.dt * rate).flux);
    const auto [least, largest] = std::minmax_element(flux.begin(), flux.end());
    out.least_flux = *least;
    out.largest_flux = *largest;
    // ε must not become negative. Otherwise only a part of the change is applied; the
    // response to it is linear.
    const double part = *least < 0.0 ? 1.0 / (1.0 - *least) : 1.0;
    std::vector<perturbed_cell> cells;
    for (std::size_t k = 0; k < flux.size(); ++k) {
      const double change = 1.0 + part * (flux[k] - 1.0), rate = first_rates_[k];
      const double exact = exact_layer(rate, end_);
      const double in_stages = steps.dt * rate < 1e-6 ? exact : layer_in_stages(b, steps, rate);
      cells.push_back(
          {epsilon_[k] * change, exact + part * (in_stages - exact) - exact_layer(rate / change, end_)});
    }
    out.of_moments = norms(solution_of(cells), part);
    return out;
  }

  /// Returns the names of the invariants.
  std::vector<std::string> invariants() const { return equation_->invariants(); }
  /// Returns the extremes of ε/C over the cells.
  std::pair<double, double> extremes_of_epsilon() const {
    double lowest = std::numeric_limits<double>::infinity(), highest = 0.0;
    for (const double rate : middle_rates_) {
      if (rate == 0.0) continue;  // solid
      lowest = std::min(lowest, 1.0 / rate);
      highest = std::max(highest, 1.0 / rate);
    }
    return {lowest, highest};
  }

 private:
  std::unique_ptr<semidiscrete_problem> with_epsilon(problem_builder::scale epsilon) const {
    return problem_builder(setup_.builder()).with_epsilon(std::move(epsilon)).build();
  }

  /// Returns C/ε of every cell; 0 in solid cells.
  std::vector<double> rates(const field& u) const {
    std::vector<double> omega(static_cast<std::size_t>(equation_->moment_count())), all;
    for (int cell = 0; cell < u.cells(); ++cell) {
      const bool gas = setup_.mesh().solid(cell) < 0;
      if (gas) equation_->moments(u.row(cell), omega.data());
      all.push_back(gas ? equation_->rate(omega.data()) / epsilon_[static_cast<std::size_t>(cell)] : 0.0);
    }
    return all;
  }

  /// Solves with the same steps for every problem, so that their errors cancel in differences.
  field solve(semidiscrete_problem& problem, field u, std::vector<double>* at_half_time) const {
    const step_sequence steps(end_, std::min(dt_, setup_.cfl_length()), relaxation_time_, default_growth);
    stepper march(find_method("ars-443"), problem);
    double t = 0.0;
    for (const double part : steps.first) {
      march.step(t, part, u);
      t += part;
    }
    for (long n = 1; n <= steps.further; ++n) {
      control_.check();
      if (at_half_time != nullptr && at_half_time->empty() && 2 * n > steps.further) *at_half_time = rates(u);
      march.step(static_cast<double>(n) * steps.dt, steps.dt, u);
    }
    if (at_half_time != nullptr && at_half_time->empty()) *at_half_time = rates(u);
    return u;
  }

  /// Returns the solution with a changed ε, from data shifted by −layer T′(E) D₀.
  field solution_of(const std::vector<perturbed_cell>& cells) const {
    std::map<position, double> changed;
    field shifted = equilibrium_, u = start_;
    for (int cell = 0; cell < u.cells(); ++cell) {
      const auto& one = cells[static_cast<std::size_t>(cell)];
      changed[setup_.mesh().centre(cell)] = one.epsilon;
      for (int k = 0; k < u.components(); ++k)
        shifted.row(cell)[k] -= one.layer * (equilibrium_.row(cell)[k] - start_.row(cell)[k]);
    }
    const auto problem = with_epsilon([&changed](const position& x) { return changed.at(x); });
    const target<field, double> add[] = {{&u, 0.0, 1.0, false}}, subtract[] = {{&u, 0.0, -1.0, false}};
    problem->add_transport(0.0, shifted, add);
    problem->add_transport(0.0, equilibrium_, subtract);
    return solve(*problem, std::move(u), nullptr);
  }

  /// Returns the l2 norms of (u − solution)/part in the densities of the invariants.
  std::vector<double> norms(const field& u, double part) const {
    const std::size_t count = equation_->invariants().size();
    std::vector<double> sums(count), here(count), there(count);
    for (int cell = 0; cell < u.cells(); ++cell) {
      equation_->invariant_densities(u.row(cell), here.data());
      equation_->invariant_densities(solution_.row(cell), there.data());
      for (std::size_t k = 0; k < count; ++k) sums[k] += (here[k] - there[k]) * (here[k] - there[k]);
    }
    for (double& sum : sums) sum = std::sqrt(sum * setup_.cell_volume()) / part;
    return sums;
  }

  const study_control& control_;
  run_setup setup_;
  const relaxation_model* equation_;
  double end_, dt_, relaxation_time_ = 0.0;
  field start_, equilibrium_, solution_;
  std::vector<double> epsilon_, first_rates_, middle_rates_;
};

}  // namespace

profile_errors predict_profile_errors(const case_config& config, int halvings, const study_control& control) {
  const method& m = find_method(config.time.method);
  if (m.kind != method_kind::imex)
    throw input_error(
        place_of(config, "time.method"),
        fmt::format(
            "the O(epsilon) terms of method '{}' cannot be predicted (it is no IMEX method); choose one",
            m.name));
  double dt = step_of(config);
  const response of(config, dt, control);
  const auto b = to_butcher(m.coefficients<double>());
  profile_errors out;
  std::tie(out.smallest_epsilon, out.largest_epsilon) = of.extremes_of_epsilon();
  out.invariants = of.invariants();
  for (int k = 0; k <= halvings; ++k, dt /= 2) {
    control.report(static_cast<double>(k) / (halvings + 1), fmt::format("dt = {:.3g}", dt));
    out.rows.push_back(of.to(b, dt, config));
  }
  return out;
}

}  // namespace apsis
