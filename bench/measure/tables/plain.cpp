// Speed of the library relative to its formulas in plain loops.
#include "measure/clock.hpp"
#include "measure/table.hpp"
#include "plain/bgk.hpp"

#include <apsis/integrate/stepper.hpp>
#include <apsis/model/expression.hpp>
#include <apsis/run/setup.hpp>
#include <apsis/run/simulation.hpp>
#include <apsis/scheme/quartic.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace apsis::bench::plain_table {
namespace {

const char* const test = "paper/bgk-mixed";

case_config case_with(const std::string& name) {
  return load_case(test, {"time.method=" + name, "time.end=1e6"});
}

plain::method plain_method(const method& m) {
  const auto form = m.coefficients<double>();
  const std::size_t s = form.stages();
  plain::method same{
      static_cast<int>(s), std::vector<double>(s * s), std::vector<double>(s * s), {}, form.ddot, form.r};
  for (std::size_t i = 0; i < s; ++i) {
    same.d.push_back(form.D(i, i));
    for (std::size_t j = 0; j < s; ++j) {
      same.P[i * s + j] = form.P(i, j);
      same.W[i * s + j] = form.W(i, j);
    }
  }
  return same;
}

plain::bgk::mesh plain_mesh(const case_config& config, const run_setup& setup) {
  const auto v = setup.equation->speeds(0);
  const auto& [from, to] = config.space.domain.front();
  plain::bgk::mesh mesh{
      config.space.cells.front(), (to - from) / config.space.cells.front(), {v.begin(), v.end()}, {}};
  const expression formula = make_epsilon(config, 1);
  for (int cell = 0; cell < mesh.cells; ++cell)
    for (const double xi : gauss3::xi)
      mesh.epsilon.push_back(formula.evaluate(setup.builder().mesh().centre(cell, 0) + xi * mesh.dx));
  return mesh;
}

std::vector<double> numbers_of(const field& u) {
  std::vector<double> numbers;
  for (int cell = 0; cell < u.cells(); ++cell)
    numbers.insert(numbers.end(), u.row(cell), u.row(cell) + u.components());
  return numbers;
}

double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0.0, size = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    difference += (a[k] - b[k]) * (a[k] - b[k]);
    size += b[k] * b[k];
  }
  return std::sqrt(difference / size);
}

/// One run in several implementations.
struct contest {
  explicit contest(const std::string& name)
      : config(case_with(name)),
        setup(config),
        problem(setup.make_problem()),
        march(setup.integrator().starter(), *problem),
        by_library(setup.initial_state()),
        by_formulas(plain::make_bgk(plain_mesh(config, setup), plain_method(setup.integrator().starter()))),
        for_this_processor(
            plain::make_native_bgk(plain_mesh(config, setup), plain_method(setup.integrator().starter()))),
        f(numbers_of(by_library)),
        f_native(f),
        with_checks(config),
        dt(with_checks.dt()) {}

  void library(int steps) {
    for (int n = 0; n < steps; ++n, t += dt) march.step(t, dt, by_library);
  }
  void formulas(int steps) {
    for (int n = 0; n < steps; ++n) by_formulas->step(dt, f);
  }
  void native_formulas(int steps) {
    for (int n = 0; n < steps; ++n) for_this_processor->step(dt, f_native);
  }
  void simulated(int steps) {
    for (int n = 0; n < steps; ++n) with_checks.advance();
  }

  case_config config;
  run_setup setup;
  std::unique_ptr<semidiscrete_problem> problem;
  stepper<semidiscrete_problem> march;
  field by_library;
  std::unique_ptr<plain::bgk> by_formulas, for_this_processor;
  std::vector<double> f, f_native;
  simulation with_checks;
  double dt, t = 0.0;
};

/// Returns the largest difference of the results. Throws unless they agree, because the comparison would
/// otherwise be meaningless.
double require_agreement(contest& all, int steps) {
  all.library(steps);
  all.formulas(steps);
  all.native_formulas(steps);
  const auto f = numbers_of(all.by_library);
  const double difference = std::max(relative_difference(all.f, f), relative_difference(all.f_native, f));
  if (!(difference < 1e-10))
    throw std::runtime_error(
        fmt::format("the plain code differs from the library by {:.2g} after {} steps", difference, steps));
  return difference;
}

result_table measure(const settings& options) {
  result_table result;
  result.title = "Library and plain loops, mixed-regime BGK";
  result.note =
      "The table shows milliseconds per step of paper/bgk-mixed on one thread (40 cells, 150 velocities, "
      "finite volumes). Column `plain` has plain loops (bench/plain) with the flags of the library. "
      "Column `native` has the same loops with -O3 -march=native -ffast-math. Column `library` has the "
      "step of the library alone. Column `advance` has simulation::advance(), which also checks every "
      "step. Ratios are medians over the turns. Column `difference` has the largest relative difference "
      "of the results after a few steps, in the 2-norm over f.";
  result.columns = {"method",        "plain (ms)",     "native (ms)",   "library (ms)", "advance (ms)",
                    "plain/library", "native/library", "plain/advance", "difference"};
  // Jobs are short and turns many, so that a disturbance affects only one turn.
  const int steps = options.quick ? 2 : 10, turns = options.quick ? 1 : 5 * options.repeats;
  for (const std::string name : {"md-imex-3-2", "md-imex-6-3"}) {
    contest all(name);
    const double difference = require_agreement(all, options.quick ? 5 : 20);
    const auto seconds = in_turns({[&] { all.formulas(steps); }, [&] { all.native_formulas(steps); },
                                   [&] { all.library(steps); }, [&] { all.simulated(steps); }},
                                  turns);
    const auto milliseconds = [&](std::size_t job) { return 1e3 * median(seconds[job]) / steps; };
    result.rows.push_back({name, milliseconds(0), milliseconds(1), milliseconds(2), milliseconds(3),
                           median_ratio(seconds, 0, 2), median_ratio(seconds, 1, 2),
                           median_ratio(seconds, 0, 3), difference});
  }
  return result;
}

const registered here({"plain", "library against the same formulas in plain loops", measure});

}  // namespace
}  // namespace apsis::bench::plain_table
