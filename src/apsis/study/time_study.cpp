#include <apsis/study/time_study.hpp>

#include <apsis/core/errors.hpp>
#include <apsis/core/extremes.hpp>
#include <apsis/core/graded_start.hpp>
#include <apsis/integrate/extrapolation.hpp>
#include <apsis/integrate/integrate.hpp>
#include <apsis/run/setup.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace apsis {

double largest_difference(const field& u, const field& v) {
  double largest = 0.0;
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k)
      largest = maximum(largest, std::abs(u.row(cell)[k] - v.row(cell)[k]));
  return largest;
}

struct time_study::impl {
  run_setup setup, limit_setup;
  const relaxation_model* equation;
  double epsilon, end;
  std::unique_ptr<semidiscrete_problem> limit;  ///< ε = 0, to find equilibria

  static case_config with_epsilon(case_config config, double epsilon) {
    config.space.discretization = "finite-difference";
    config.model.epsilon = fmt::format("{:.17g}", epsilon);
    config.time.method = "forward-backward-euler";
    config.time.safety.reset();
    config.time.cfl.reset();
    config.time.dt = config.time.end;
    return config;
  }

  impl(const case_config& config, double eps)
      : setup(with_epsilon(config, eps)),
        limit_setup(with_epsilon(config, 0.0)),
        equation(setup.equation->as_relaxation()),
        epsilon(eps),
        end(config.time.end) {
    if (equation == nullptr)
      throw input_error(fmt::format(
          "model '{}' has no equilibrium (it is no relaxation model); choose another", config.model.name));
    limit = limit_setup.make_problem();
  }
};

time_study::time_study(const case_config& config, double epsilon)
    : impl_(std::make_unique<impl>(config, epsilon)) {}
time_study::~time_study() = default;
time_study::time_study(time_study&&) noexcept = default;

double time_study::end() const {
  return impl_->end;
}

field time_study::start(start_data data) const {
  field u = impl_->setup.initial_state();
  if (data == start_data::equilibrium) impl_->limit->solve_collision(0.0, 1.0, 0.0, u);
  return u;
}

field time_study::solve(const method& m, long steps, start_data data, first_step first,
                        const study_control& control) const {
  const auto problem = impl_->setup.make_problem();
  stepper march(m, *problem);
  field u = start(data);
  const double dt = impl_->end / static_cast<double>(steps);
  double t = 0.0;
  if (first == first_step::resolved) {
    double fastest = 0.0;
    std::vector<double> omega(static_cast<std::size_t>(impl_->equation->moment_count()));
    for (int cell = 0; cell < u.cells(); ++cell) {
      impl_->equation->moments(u.row(cell), omega.data());
      fastest = maximum(fastest, impl_->equation->rate(omega.data()));
    }
    for (const double part : graded_start(dt, impl_->epsilon / fastest)) {
      march.step(t, part, u);
      t += part;
    }
    if (--steps == 0) return u;
    t = dt;
  }
  integrate(march, u, t, impl_->end, step_rule<double>::fixed((impl_->end - t) / static_cast<double>(steps)),
            [&](long, double, double, const field&) { control.check(); });
  return u;
}

field time_study::reference(start_data data, double tolerance, const study_control& control) const {
  const auto problem = impl_->setup.make_problem();
  field u = start(data);
  extrapolate(*problem, u, 0.0, impl_->end, {tolerance, 0.0, 8}, [&](const field& a, const field& b) {
    control.check();
    return largest_difference(a, b);
  });
  return u;
}

std::vector<double> time_study::moments(const field& u) const {
  const auto count = static_cast<std::size_t>(impl_->equation->moment_count());
  std::vector<double> omega(static_cast<std::size_t>(u.cells()) * count);
  for (int cell = 0; cell < u.cells(); ++cell)
    impl_->equation->moments(u.row(cell), omega.data() + static_cast<std::size_t>(cell) * count);
  return omega;
}

std::vector<double> time_study::deviation(const field& u) const {
  field e = u;
  impl_->limit->solve_collision(0.0, 1.0, 0.0, e);
  std::vector<double> d;
  for (int cell = 0; cell < u.cells(); ++cell)
    for (int k = 0; k < u.components(); ++k) d.push_back(e.row(cell)[k] - u.row(cell)[k]);
  return d;
}

}  // namespace apsis
