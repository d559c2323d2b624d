// Heap allocations of a step. The first step allocates the buffers of its schedule, later steps nothing.
#include "bgk_case.hpp"

#include <apsis/exec/parallel.hpp>
#include <apsis/integrate/error_control.hpp>
#include <apsis/integrate/stepper.hpp>
#include <apsis/semidiscrete/budgeted_problem.hpp>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> allocations = 0, bytes_of_fields = 0;
std::atomic<std::size_t> size_of_field = ~std::size_t{0};

void* counted_allocation(std::size_t size, std::size_t alignment) {
  ++allocations;
  if (size >= size_of_field) bytes_of_fields += static_cast<long>(size);
  void* p = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}

}  // namespace

// These functions replace the global allocation functions of the test program. If the compiler inlines one
// half of a pair, it does not recognise the other half.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
void* operator new(std::size_t size) {
  return counted_allocation(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted_allocation(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace {

using limits = apsis::limited_reconstruction::limits;

enum class unknowns { averages, averages_at_centres, points };

apsis::semidiscrete_problem problem_of(const apsis::relaxation_model& m, const apsis::grid& mesh,
                                       unknowns what) {
  const auto cells = static_cast<std::size_t>(mesh.size());
  if (what == unknowns::points)
    return upwind_problem(m, space_of(mesh), scheme("weno5-z", limits::fluxes),
                          apsis::make_pointwise_collision(m, std::vector<double>(cells, 1e-3)));
  const auto how = scheme("weno5-z", limits::edges);
  const auto space = space_of(mesh);
  if (what == unknowns::averages_at_centres)
    return upwind_problem(
        m, space, how, apsis::make_cell_centre_collision(m, space, true, std::vector<double>(cells, 1e-3)));
  return upwind_problem(
      m, space, how, apsis::make_cell_average_collision(m, space, how, std::vector<double>(3 * cells, 1e-3)));
}

struct heap_use {
  long fields, in_later_steps;
};

heap_use measure(const std::string& method, unknowns what) {
  constexpr int cells = 200;
  const auto m = small_bgk();
  const apsis::grid mesh = apsis::grid::line(cells, 0.0, 2.0);
  auto problem = problem_of(*m, mesh, what);
  apsis::stepper stepper(apsis::find_method(method), problem);
  // The grid resolves these equilibria far from its ends. Newton's method is not needed; it would allocate
  // scratch memory at its first use in a thread.
  apsis::field u = sample(mesh, m->components(), false, [](double x, int k) {
    return (1.5 + std::sin(3.0 * x)) * std::exp(-0.14 * (k - 20.0) * (k - 20.0));
  });
  const double dt = stepper.r() * problem.forward_euler_step(0.0, u);
  size_of_field = static_cast<std::size_t>(cells) * static_cast<std::size_t>(u.stride()) * sizeof(double);
  bytes_of_fields = 0;
  stepper.step(0.0, dt, u);
  const long fields = bytes_of_fields / static_cast<long>(size_of_field.load());
  EXPECT_EQ(bytes_of_fields % static_cast<long>(size_of_field.load()), 0);
  size_of_field = ~std::size_t{0};
  stepper.step(0.0, dt, u);
  const long before = allocations;
  for (int step = 0; step < 5; ++step) stepper.step(0.0, dt, u);
  return {fields, allocations - before};
}

}  // namespace

TEST(allocations, the_first_step_takes_the_buffers_of_its_schedule_and_later_steps_none) {
  for (const int threads : {1, 2}) {
    apsis::set_threads(threads);
    for (const char* method :
         {"md-imex-3-2", "md-imex-6-3", "md-imex-8-3-mixed", "ssprk-3-3", "hsz-ars-4-2"}) {
      const apsis::schedule plan(apsis::find_method(method).coefficients<double>());
      const auto points = measure(method, unknowns::points), averages = measure(method, unknowns::averages),
                 centres = measure(method, unknowns::averages_at_centres);
      EXPECT_EQ(points.fields, plan.buffers() - 1) << method << ", u^n belongs to the user";
      // Collisions of cell averages read the old values of neighbours. The new values therefore need
      // a second buffer.
      EXPECT_EQ(averages.fields, plan.buffers() - 1 + (plan.implicit_solves() > 0 ? 1 : 0)) << method;
      // At centres the changes of the point values, which neighbours read, need a buffer too.
      const bool collides = plan.implicit_solves() > 0 || plan.collision_evaluations() > 0;
      EXPECT_EQ(centres.fields, averages.fields + (collides ? 1 : 0)) << method;
      EXPECT_EQ(centres.in_later_steps, 0) << method << ", " << threads << " threads";
      EXPECT_EQ(points.in_later_steps, 0) << method << ", " << threads << " threads";
      EXPECT_EQ(averages.in_later_steps, 0) << method << ", " << threads << " threads";
    }
  }
  apsis::set_threads(1);
}

namespace {

/// Returns a boundary of a kind with values that are functions of time, or numbers. ρ, T, p and
/// f need values.
std::shared_ptr<const apsis::boundary> end_of(const apsis::boundary_entry& kind, const apsis::model& gas,
                                              bool constant) {
  apsis::face_quantities values;
  for (const auto& variable :
       kind.variables != nullptr ? kind.variables(gas) : std::vector<apsis::data_variable>()) {
    if (values.contains(variable.alternative)) continue;
    const double number = variable.value ? *variable.value : variable.of_velocity ? 0.1 : 1.0;
    const apsis::face_quantity::function of_time = [number](double t, const apsis::position&) {
      return number * (1.0 - 0.01 * t);
    };
    values[variable.name].assign(static_cast<std::size_t>(variable.size),
                                 constant ? apsis::face_quantity(number) : apsis::face_quantity(of_time));
  }
  return apsis::make_boundary(kind.name, gas, values);
}

/// Returns the number of allocations of five steps with this end at all faces, on a line or in the plane
/// around a solid box.
long allocations_beside(const apsis::boundary_entry& kind, bool in_plane, bool constant, unknowns what) {
  const auto gas = small_bgk(in_plane ? 14 : 40, in_plane ? 7.0 : 8.0, in_plane ? 2 : 1);
  const auto side = end_of(kind, *gas, constant);
  apsis::grid mesh = apsis::grid::line(40, 0.0, 2.0);
  std::vector<std::shared_ptr<const apsis::boundary>> solids;
  if (in_plane) {
    apsis::cell_box box;
    box.first = {6, 5, 0};
    box.cells = {2, 2, 1};
    mesh = apsis::grid(2, {12, 11, 1}, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}).with_solids({box});
    solids.push_back(apsis::make_boundary("symmetry", *gas));
  }
  const std::vector<apsis::domain::faces> sides(in_plane ? 2 : 1, {side, side});
  const auto space =
      std::make_shared<apsis::domain>(apsis::phase_space{mesh, gas->velocities()}, sides, solids);
  const auto cells = static_cast<std::size_t>(mesh.size());
  const bool points = what == unknowns::points;
  const auto how = scheme("weno5-z", points ? limits::fluxes : limits::edges);
  apsis::semidiscrete_problem problem = upwind_problem(
      *gas, space, how,
      points ? apsis::make_pointwise_collision(*gas, std::vector<double>(cells, 1e-3))
             : apsis::make_cell_average_collision(*gas, space, how, std::vector<double>(3 * cells, 1e-3)));
  apsis::budgeted_problem budgeted(problem);
  apsis::stepper stepper(apsis::find_method("md-imex-6-3"), budgeted);
  apsis::budgeted_state now{apsis::field(mesh.size(), gas->components()), {}};
  apsis::field& u = now.unknowns;
  std::vector<double> rest(static_cast<std::size_t>(gas->components()));
  std::vector<double> state(static_cast<std::size_t>(in_plane ? 4 : 3), 0.0);
  state.front() = state.back() = 1.0;
  gas->data_forms().front().row(state, rest);
  for (int cell = 0; cell < mesh.size(); ++cell) std::copy(rest.begin(), rest.end(), u.row(cell));
  const double dt = stepper.r() * problem.forward_euler_step(0.0, u);
  const auto take_step = [&](int step) {
    now.budget.clear();
    stepper.step(step * dt, dt, now);
  };
  for (int step = 0; step < 3; ++step) take_step(step);
  const long before = allocations;
  for (int step = 3; step < 8; ++step) take_step(step);
  return allocations - before;
}

}  // namespace

TEST(allocations, are_none_after_the_first_steps_at_ends_of_every_kind) {
  for (const apsis::boundary_entry* kind : apsis::boundary_entries())
    for (const bool constant : {true, false}) {
      if (kind->name == "axis") continue;  // needs axisymmetric flow
      for (const auto what : {unknowns::points, unknowns::averages})
        EXPECT_EQ(allocations_beside(*kind, false, constant, what), 0) << kind->name << constant;
      EXPECT_EQ(allocations_beside(*kind, true, constant, unknowns::points), 0) << kind->name << constant;
    }
}

TEST(allocations, steps_to_a_tolerance_allocate_nothing_after_the_first_ones) {
  constexpr int cells = 40;
  const auto m = small_bgk();
  const apsis::grid mesh = apsis::grid::line(cells, 0.0, 2.0);
  for (const auto what : {unknowns::points, unknowns::averages, unknowns::averages_at_centres}) {
    auto problem = problem_of(*m, mesh, what);
    apsis::stepper stepper(apsis::find_method("md-imex-8-3-mixed"), problem,
                           apsis::solutions::result_and_embedded);
    apsis::field u = sample(mesh, m->components(), false, [](double x, int k) {
      return (1.5 + std::sin(3.0 * x)) * std::exp(-0.1 * (k - 20.0) * (k - 20.0));
    });
    const auto distance = [](const apsis::field& a, const apsis::field& b) {
      double sum = 0.0;
      for (int k = 0; k < a.components(); ++k) sum += std::abs(a.row(0)[k] - b.row(0)[k]);
      return sum;
    };
    apsis::step_controller<double> control(1e-3, 1);
    apsis::error_estimate<apsis::semidiscrete_problem> estimate;
    apsis::time_marcher<double> march(0.0, 1.0);
    control.start_with(1e-4);
    const auto step = [&] {
      march.advance(apsis::step_within_tolerance(stepper, march, control, estimate, 1e-3, u, distance));
    };
    for (int k = 0; k < 3; ++k) step();
    const long before = allocations;
    for (int k = 0; k < 5; ++k) step();
    EXPECT_EQ(allocations - before, 0);
  }
}

TEST(allocations, budgets_of_many_ends_are_combined_without_any_after_the_first_step) {
  apsis::boundary_budget u, stage;
  const std::vector<double> rates(1000, 1.0);
  long before = 0;
  for (int step = 0; step < 3; ++step) {
    if (step == 1) before = allocations;
    u.clear();
    stage.combine(1.0, u, 0.5, rates, true);
    u.combine(0.5, stage, 0.5, rates, false);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_EQ(u.amounts().at(999), 0.75);
}
